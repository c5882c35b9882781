// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/shape/contact_tracks.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

class ContactTracksTest : public testing::Test {
 protected:
  ContactTracksTest()
      : model_(Build(BeamRobot())),
        tracks_(*model_, ShapeConfig()),
        x_m_(model_->RestState().x_m) {}

  static SeenContact Contact(const std::string& name, const Eigen::Vector3d& position_m) {
    return {.name = name,
            .position_m = position_m,
            .covariance_m2 = 4e-6 * Eigen::Matrix3d::Identity(),
            .extent_m = Eigen::Vector3d::Constant(0.01),
            .point_count = 30};
  }
  using Evidence = ContactTracks::Evidence;

  void JudgeAll(bool significant, bool quiet) {
    const Evidence evidence = significant ? Evidence::kSignificant : Evidence::kNone;
    for (size_t s = 0; s < tracks_.sites().size(); ++s) tracks_.Judge(s, evidence, quiet);
  }

  std::unique_ptr<robot::RobotModel> model_;
  ContactTracks tracks_;
  Eigen::VectorXd x_m_;
  const Eigen::Vector3d tip_{0.0, 0.015, 0.03};
  const Eigen::Vector3d middle_{-0.05, 0.015, 0.03};
};

TEST_F(ContactTracksTest, ContactsComeAndGoWithPerception) {
  EXPECT_TRUE(tracks_.See({Contact("a", tip_)}, x_m_));
  ASSERT_EQ(tracks_.sites().size(), 1u);
  EXPECT_LT((tracks_.sites()[0].centre.rest_m - tip_).norm(), 1e-6);
  EXPECT_NEAR(tracks_.sites()[0].seen_sigma_m, 2e-3, 1e-9);
  EXPECT_FALSE(tracks_.See({Contact("a", tip_)}, x_m_));
  EXPECT_TRUE(tracks_.See({Contact("a", tip_), Contact("b", middle_)}, x_m_));
  EXPECT_TRUE(tracks_.See({Contact("b", middle_)}, x_m_));
  ASSERT_EQ(tracks_.sites().size(), 1u);
  EXPECT_EQ(tracks_.sites()[0].name, "b");
  EXPECT_TRUE(tracks_.See({}, x_m_));
  EXPECT_TRUE(tracks_.sites().empty());
}

TEST_F(ContactTracksTest, AContactFarFromTheSkinIsLeftOut) {
  EXPECT_FALSE(tracks_.See({Contact("far", tip_ + Eigen::Vector3d(0.1, 0, 0.1))}, x_m_));
  EXPECT_TRUE(tracks_.sites().empty());
}

TEST_F(ContactTracksTest, NoMoreContactsThanCanBeFitted) {
  std::vector<SeenContact> many;
  for (int k = 0; k < 10; ++k) {
    const Eigen::Vector3d aside_m(-0.018 * (k / 2), k % 2 == 0 ? -0.012 : 0.012, 0.0);
    many.push_back(Contact("c" + std::to_string(k), tip_ + aside_m));
  }
  tracks_.See(many, x_m_);
  EXPECT_TRUE(tracks_.full());
  EXPECT_EQ(tracks_.sites().size(), 5u);
}

TEST_F(ContactTracksTest, WhatIsSeenSoNearToAContactThatItMayBeTheSameIsAPartOfIt) {
  const auto at = [&](double aside_m, double sigma_m) {
    SeenContact contact = Contact("b", tip_ - Eigen::Vector3d(aside_m, 0, 0));
    contact.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    return contact;
  };
  const SeenContact first = Contact("a", tip_);  // known to 2 mm
  for (const auto& [second, is_another] :
       {std::pair(at(0.009, 1e-3), false), std::pair(at(0.011, 1e-3), true),
        std::pair(at(0.019, 1e-2), false), std::pair(at(0.022, 1e-2), true)}) {
    tracks_.Forget();
    tracks_.See({first, second}, x_m_);
    EXPECT_EQ(tracks_.sites().size(), is_another ? 2u : 1u) << second.position_m.transpose();
    EXPECT_EQ(tracks_.sites()[0].name, "a");
  }
}

TEST_F(ContactTracksTest, AContactThatPullsPushesFromTheOtherSideOfTheLimb) {
  const Eigen::Vector3d up(0, 0, 0.5);
  const auto seen_within = [&](double sigma_m) {
    tracks_.Forget();
    SeenContact contact = Contact("a", middle_);
    contact.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    tracks_.See({contact}, x_m_);
    return contact;
  };
  seen_within(0.005);  // the beam is 30 mm thick
  EXPECT_FALSE(tracks_.TurnOver(0, up));
  const SeenContact contact = seen_within(0.011);
  EXPECT_TRUE(tracks_.TurnOver(0, up));
  const Eigen::Vector3d below_m = middle_ - Eigen::Vector3d(0, 0, 0.03);
  EXPECT_LT((tracks_.sites()[0].centre.rest_m - below_m).norm(), 2e-3);
  EXPECT_GT(tracks_.sites()[0].patch.normal.dot(Eigen::Vector3d(0, 0, -1)), 0.9);
  tracks_.See({contact}, x_m_);  // perception says what it said before
  EXPECT_LT((tracks_.sites()[0].centre.rest_m - below_m).norm(), 2e-3);
  EXPECT_LT((tracks_.sites()[0].seen_rest_m - below_m).norm(), 2e-3);
  EXPECT_FALSE(tracks_.TurnOver(0, -up)) << "once is enough";
}

TEST_F(ContactTracksTest, AContactWhosePlaceWasMeasuredStaysThere) {
  SeenContact contact = Contact("given", middle_);
  contact.covariance_m2 = 2.5e-7 * Eigen::Matrix3d::Identity();
  tracks_.See({contact}, x_m_);
  EXPECT_FALSE(tracks_.TurnOver(0, {0, 0, 0.5}));
}

TEST_F(ContactTracksTest, WhereASequenceBeginsASignificantForceIsBelievedAtOnce) {
  HiddenContact found;
  found.rest_position_m = tip_;
  tracks_.ReplaceHidden({found});
  tracks_.See({Contact("a", middle_)}, x_m_);
  for (size_t s = 0; s < 2; ++s) {
    tracks_.Judge(s, Evidence::kNone, false, true);
    EXPECT_FALSE(tracks_.sites()[s].acts);
    tracks_.Judge(s, Evidence::kSignificant, false, true);
    EXPECT_TRUE(tracks_.sites()[s].acts);
  }
}

TEST_F(ContactTracksTest, AForceIsReportedAfterTwoFramesAndUntilThreeQuietOnes) {
  tracks_.See({Contact("a", tip_)}, x_m_);
  JudgeAll(true, false);
  EXPECT_FALSE(tracks_.sites()[0].acts);
  JudgeAll(false, false);
  JudgeAll(true, false);
  EXPECT_FALSE(tracks_.sites()[0].acts);
  JudgeAll(true, false);
  EXPECT_TRUE(tracks_.sites()[0].acts);
  JudgeAll(false, false);  // neither significant nor quiet
  JudgeAll(false, true);
  JudgeAll(false, true);
  EXPECT_TRUE(tracks_.sites()[0].acts);
  JudgeAll(false, true);
  EXPECT_FALSE(tracks_.sites()[0].acts);
}

TEST_F(ContactTracksTest, AHiddenContactGivesWayToOneThatComesIntoView) {
  HiddenContact found;
  found.rest_position_m = tip_ - Eigen::Vector3d(0.008, 0, 0);
  tracks_.ReplaceHidden({found});
  ASSERT_EQ(tracks_.sites().size(), 1u);
  EXPECT_EQ(tracks_.sites()[0].name, "hidden_1");
  EXPECT_TRUE(tracks_.See({Contact("a", tip_)}, x_m_));
  ASSERT_EQ(tracks_.sites().size(), 1u);
  EXPECT_EQ(tracks_.sites()[0].name, "a");
}

TEST_F(ContactTracksTest, AForceBeyondDoubtIsBelievedAfterHalfTheFrames) {
  tracks_.See({Contact("doubted", tip_), Contact("sure", middle_)}, x_m_);
  tracks_.Judge(0, Evidence::kSignificant, false);
  tracks_.Judge(1, Evidence::kBeyondDoubt, false);
  EXPECT_FALSE(tracks_.sites()[0].acts);
  EXPECT_TRUE(tracks_.sites()[1].acts);
}

TEST_F(ContactTracksTest, AForceGoesOnWhenItsContactGoesOutOfSightAndComesBack) {
  tracks_.See({Contact("a", tip_), Contact("idle", middle_)}, x_m_);
  for (int k = 0; k < 2; ++k) {
    tracks_.Judge(0, Evidence::kSignificant, false);
    tracks_.Judge(1, Evidence::kNone, true);
  }
  EXPECT_TRUE(tracks_.See({}, x_m_));
  ASSERT_EQ(tracks_.sites().size(), 1u);
  EXPECT_EQ(tracks_.sites()[0].name, "hidden_1");
  EXPECT_TRUE(tracks_.sites()[0].hidden);
  EXPECT_TRUE(tracks_.sites()[0].acts);
  EXPECT_TRUE(tracks_.See({Contact("b", tip_ - Eigen::Vector3d(0.003, 0, 0))}, x_m_));
  ASSERT_EQ(tracks_.sites().size(), 1u);
  EXPECT_EQ(tracks_.sites()[0].name, "b");
  EXPECT_FALSE(tracks_.sites()[0].hidden);
  EXPECT_TRUE(tracks_.sites()[0].acts);
}

TEST_F(ContactTracksTest, AHiddenContactStaysUntilItIsQuietAndItsNameIsNotUsedAgain) {
  HiddenContact found;
  found.rest_position_m = middle_;
  tracks_.ReplaceHidden({found});
  tracks_.See({}, x_m_);
  EXPECT_EQ(tracks_.sites().size(), 1u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(tracks_.ForgetQuiet());
    JudgeAll(false, true);
  }
  EXPECT_TRUE(tracks_.ForgetQuiet());
  EXPECT_TRUE(tracks_.sites().empty());
  tracks_.ReplaceHidden({found});
  EXPECT_EQ(tracks_.sites()[0].name, "hidden_2");
}

TEST_F(ContactTracksTest, AContactIsPlacedAgainWhereItIsSeenFarFromWhereItWas) {
  tracks_.See({Contact("a", tip_)}, x_m_);
  EXPECT_FALSE(tracks_.See({Contact("a", tip_ - Eigen::Vector3d(0.003, 0, 0))}, x_m_));
  EXPECT_LT((tracks_.sites()[0].centre.rest_m - tip_).norm(), 1e-6);
  EXPECT_TRUE(tracks_.See({Contact("a", middle_)}, x_m_));
  EXPECT_LT((tracks_.sites()[0].centre.rest_m - middle_).norm(), 1e-6);
}

TEST_F(ContactTracksTest, SmallMovesAreNotMade) {
  tracks_.See({Contact("a", middle_)}, x_m_);
  EXPECT_FALSE(tracks_.Move(0, Eigen::Vector3d(1e-4, 0, 0)));
  EXPECT_TRUE(tracks_.Move(0, Eigen::Vector3d(2e-3, 0, 0)));
  EXPECT_LT((tracks_.sites()[0].centre.rest_m - middle_ - Eigen::Vector3d(2e-3, 0, 0)).norm(),
            1e-6);
}

}  // namespace
}  // namespace palpate::force_estimation
