// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "components/force_estimation/shape/contact_report.hpp"
#include "components/force_estimation/shape/hidden_contacts.hpp"
#include "components/force_estimation/shape/shape_fitter.hpp"
#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "libs/core/statistics.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

/// The four-legged robot (tet10) before the bench's camera, pushed on the hub: the parts of force
/// estimation from its shape that make a contact of what a frame shows.
class Contacts : public testing::Test {
 protected:
  static constexpr double kSeenSigma_m = 2e-3;
  static constexpr double kForce_N = 0.8;
  static constexpr double kSmallForce_N = 0.02;

  /// `noise`: standard deviation of the depth noise over that of the camera.
  explicit Contacts(unsigned seed = 1, float noise = 1.0f)
      : fit_(*scene_.model, Config(), shape_),
        hidden_(*scene_.model, shape_, fit_),
        report_(shape_, 0.0, hidden_.CandidateCount()),
        bias_(51, shape_),
        cables_(4, {.kind = Kind::kDisplacement, .value = 0.0}),
        noise_(noise),
        random_(seed),
        free_(Solve(0.0)) {
    fit_.StartAt(free_);
    for (int k = 0; k < 6; ++k) {
      const ShapeFrame frame = FrameOf(free_);
      EXPECT_TRUE(fit_.Match(frame).ok());
      bias_.HaveCameras(1);
      bias_.Learn(fit_.matches(), free_.x_m, frame.Poses(), 0);
    }
    fit_.SetBiasShape(free_.x_m);
    EXPECT_TRUE(bias_.Finish().ok());
  }

  fem::StaticState Solve(double force_N) { return SolveAt(place_m_, force_N); }

  fem::StaticState SolveAt(const Eigen::Vector3d& place_m, double force_N) {
    fem::StaticState state = scene_.model->RestState();
    const fem::SurfacePatch patch = scene_.model->Patch(place_m, shape_.contact_radius_m);
    const auto result =
        scene_.model->Solve(cables_, {{patch.weights, -force_N * patch.normal}}, &state);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    pushed_at_m_ = patch.weights.Position(state.x_m);
    return state;
  }

  ShapeFrame FrameOf(const fem::StaticState& state) {
    ShapeFrame frame;
    frame.t_s = (t_s_ += 0.033);
    frame.views[0].T_robot_camera = BenchPose();
    frame.views[0].cloud = Cast(scene_, state.x_m, frame.views[0].T_robot_camera);
    AddDepthNoise(random_, &frame.views[0].cloud, noise_);
    frame.cables = cables_;
    return frame;
  }

  ShapeFrame SeenFrameOf(const fem::StaticState& state) {
    ShapeFrame frame = FrameOf(state);
    frame.contacts = {{.name = "finger",
                       .position_m = pushed_at_m_,
                       .covariance_m2 = std::pow(kSeenSigma_m, 2) * Eigen::Matrix3d::Identity(),
                       .extent_m = Eigen::Vector3d::Zero(),
                       .point_count = 50}};
    return frame;
  }

  void Fit(const ShapeFrame& frame) {
    fit_.See(frame);
    const Status status = fit_.MatchAndFit(frame, bias_);
    ASSERT_TRUE(status.ok()) << status.message();
  }

  const Eigen::Vector3d place_m_{0.0212, -0.0212, 0.103};
  ShapeScene scene_{51};
  ShapeConfig shape_;
  ShapeFitter fit_;
  HiddenContacts hidden_;
  ContactReport report_;
  CameraBiases bias_;
  std::vector<robot::ActuatorCommand> cables_;
  double t_s_ = 0.0;
  float noise_;
  std::mt19937 random_;
  Eigen::Vector3d pushed_at_m_ = Eigen::Vector3d::Zero();
  fem::StaticState free_;
};

TEST_F(Contacts, BeyondDoubtAreReportedFromTheirFirstFrameOn) {
  Fit(SeenFrameOf(Solve(kForce_N)));
  report_.Judge(t_s_, false, &fit_);
  EXPECT_EQ(report_.Contacts(fit_).size(), 1u);
}

TEST_F(Contacts, AreReportedFromTheSecondFrameThatShowsThemOn) {
  const fem::StaticState pushed = Solve(kSmallForce_N);
  Fit(SeenFrameOf(pushed));
  report_.Judge(t_s_, false, &fit_);
  EXPECT_TRUE(report_.Contacts(fit_).empty());
  Fit(SeenFrameOf(pushed));
  report_.Judge(t_s_, false, &fit_);
  const std::vector<ContactForce> contacts = report_.Contacts(fit_);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].name, "finger");
  EXPECT_NEAR(contacts[0].force_N.norm(), kSmallForce_N, 2.0 * contacts[0].ci95_N);
  // Along the force: the interval of so small a force also holds what is across it.
  const Eigen::Vector3d along = contacts[0].force_N.normalized();
  const double sigma_N = std::sqrt(along.dot(contacts[0].covariance_N2 * along));
  EXPECT_LT(kSigmas95 * sigma_N, 0.5 * kSmallForce_N);
}

TEST_F(Contacts, WhosePlaceWasNotFittedAreAsUncertainAsTheyWereSeen) {
  const fem::StaticState pushed = Solve(kForce_N);
  for (int k = 0; k < 2; ++k) {
    Fit(SeenFrameOf(pushed));
    report_.Judge(t_s_, false, &fit_);
  }
  ASSERT_TRUE(fit_.located().empty());
  const double seen_m = report_.Contacts(fit_).at(0).location_ci95_m;
  const double radius = std::sqrt(ChiSquaredQuantile(0.95, 2));  // of two directions, in sigmas
  EXPECT_GE(seen_m, 0.999 * radius * kSeenSigma_m);
  ASSERT_TRUE(fit_.Locate(SeenFrameOf(pushed), bias_).ok());
  ASSERT_EQ(fit_.located().size(), 1u);
  const double fitted_m = report_.Contacts(fit_).at(0).location_ci95_m;
  EXPECT_GT(fitted_m, 0.0);
  EXPECT_LT(fitted_m, seen_m);
}

/// Along the present surface: none along its normal, and of the size that the interval has, as the
/// body hardly strains.
TEST_F(Contacts, HaveTheCovarianceOfTheirPlaceAlongTheSurface) {
  const fem::StaticState pushed = Solve(kForce_N);
  for (int k = 0; k < 2; ++k) {
    Fit(SeenFrameOf(pushed));
    report_.Judge(t_s_, false, &fit_);
  }
  ASSERT_TRUE(fit_.Locate(SeenFrameOf(pushed), bias_).ok());
  const ContactForce contact = report_.Contacts(fit_).at(0);
  const Eigen::Matrix3d& covariance_m2 = contact.location_covariance_m2;
  EXPECT_LT((covariance_m2 - covariance_m2.transpose()).norm(), 1e-12 * covariance_m2.norm());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_m2);
  EXPECT_LT(eigen.eigenvalues()[0], 1e-6 * eigen.eigenvalues()[1]);
  EXPECT_GT(std::abs(eigen.eigenvectors().col(0).dot(fit_.sites()[0].patch.normal)), 0.9);
  const double by_covariance_m =
      std::sqrt(0.5 * ChiSquaredQuantile(0.95, 2) * covariance_m2.trace());
  EXPECT_NEAR(by_covariance_m, contact.location_ci95_m, 0.1 * contact.location_ci95_m);
}

/// No shape tells of a push on the soles, which are fixed. What went there from where it pushed is
/// no longer a contact, of 0 N either.
TEST_F(Contacts, ThatWentToTheClampAreLeftOut) {
  Fit(SeenFrameOf(Solve(kForce_N)));
  report_.Judge(t_s_, false, &fit_);
  ASSERT_EQ(report_.Contacts(fit_).size(), 1u);
  pushed_at_m_ = {0.0825, 0.0, 0.0};
  Fit(SeenFrameOf(free_));
  report_.Judge(t_s_, false, &fit_);
  ASSERT_EQ(fit_.sites().size(), 1u);
  ASSERT_EQ(fit_.sites()[0].name, "finger");
  ASSERT_EQ(fit_.fitter().fit().observability[0], Observability::kNone);
  EXPECT_TRUE(report_.Contacts(fit_).empty());
}

TEST_F(Contacts, HoldZeroWhereNobodyPushes) {
  Fit(SeenFrameOf(free_));
  ASSERT_EQ(fit_.sites().size(), 1u);
  EXPECT_TRUE(report_.HoldsZero(fit_, 0));
  Fit(SeenFrameOf(Solve(kForce_N)));
  ASSERT_EQ(fit_.sites().size(), 1u);
  EXPECT_FALSE(report_.HoldsZero(fit_, 0));
}

TEST_F(Contacts, ThatNobodySeesAreFoundAndAtRestNoneIs) {
  const ShapeFrame rest = FrameOf(free_);
  for (int k = 0; k < 3; ++k) {
    Fit(rest);
    ASSERT_TRUE(hidden_.Find(rest, bias_).ok());
    EXPECT_TRUE(fit_.sites().empty());
  }
  const ShapeFrame frame = FrameOf(Solve(kForce_N));
  Fit(frame);
  ASSERT_TRUE(hidden_.Find(frame, bias_).ok());
  ASSERT_EQ(fit_.sites().size(), 1u);
  EXPECT_TRUE(fit_.sites()[0].hidden);
  EXPECT_LT((fit_.sites()[0].centre.rest_m - place_m_).norm(), 0.02);
  EXPECT_NEAR(fit_.ForceAt(0).norm(), kForce_N, 0.3 * kForce_N);
}

/// Low on a leg: where along it, and so how large the force is, is not well known, but that there
/// is one is.
TEST_F(Contacts, ThatNobodySeesAreReportedWhereverTheyMayBe) {
  constexpr double kOnLeg_N = 0.1;
  const Eigen::Vector3d on_leg_m(-0.082, -0.002, 0.054);
  const fem::StaticState pushed = SolveAt(on_leg_m, kOnLeg_N);
  for (int k = 0; k < 6; ++k) {
    const ShapeFrame frame = FrameOf(pushed);
    Fit(frame);
    ASSERT_TRUE(hidden_.Find(frame, bias_).ok());
    ASSERT_TRUE(fit_.Locate(frame, bias_).ok());
    report_.Judge(t_s_, false, &fit_);
  }
  const std::vector<ContactForce> contacts = report_.Contacts(fit_);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].force_N.norm(), kOnLeg_N, contacts[0].ci95_N);
}

/// Frames differ by their noise: their mean shows what one of them does not.
TEST_F(Contacts, ThatAreTooWeakForOneFrameAreFoundInMany) {
  constexpr double kWeak_N = 0.003;
  const fem::StaticState pushed = Solve(kWeak_N);
  const auto frames_until_found = [&](int frames, bool each_for_itself) {
    for (int k = 1; k <= frames; ++k) {
      ShapeFrame frame = FrameOf(pushed);
      if (each_for_itself) frame.t_s = 0.0;
      Fit(frame);
      EXPECT_TRUE(hidden_.Find(frame, bias_).ok());
      if (!fit_.sites().empty()) return k;
    }
    return frames + 1;
  };
  constexpr int kFrames = 20;
  EXPECT_GT(frames_until_found(kFrames, true), kFrames);
  EXPECT_LE(frames_until_found(kFrames, false), kFrames);
}

/// Placed by a search whose location leaves the force with this standard deviation: it is followed,
/// and reported where its ellipsoid does not hold zero, or where it is beyond doubt.
class HiddenContactByPlace : public Contacts {
 protected:
  void Follow(double sigma_of_place_N, double force_N = kForce_N) {
    fit_.tracks().ReplaceHidden(
        {{.rest_position_m = place_m_,
          .force_covariance_N2 = std::pow(sigma_of_place_N, 2) * Eigen::Matrix3d::Identity()}});
    Fit(FrameOf(Solve(force_N)));
    report_.Judge(t_s_, /*begins=*/true, &fit_);
    ASSERT_EQ(fit_.sites().size(), 1u);
    EXPECT_TRUE(fit_.sites()[0].acts) << "at its place the force is significant";
  }
};

TEST_F(HiddenContactByPlace, IsReportedAsHiddenWhereItsForceIsKnown) {
  ASSERT_NO_FATAL_FAILURE(Follow(0.05 * kForce_N));
  EXPECT_FALSE(report_.HoldsZero(fit_, 0));
  const std::vector<ContactForce> contacts = report_.Contacts(fit_);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].name, "hidden_1");
  EXPECT_EQ(contacts[0].status.code(), StatusCode::kHidden);
  EXPECT_NEAR(contacts[0].force_N.norm(), kForce_N, contacts[0].ci95_N);
}

TEST_F(HiddenContactByPlace, IsUncertainWhereItsPlaceLeavesAForceBeyondDoubtOpen) {
  ASSERT_NO_FATAL_FAILURE(Follow(0.5 * kForce_N));
  EXPECT_TRUE(report_.HoldsZero(fit_, 0));
  const std::vector<ContactForce> contacts = report_.Contacts(fit_);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].name, "hidden_1");
  EXPECT_EQ(contacts[0].status.code(), StatusCode::kUncertain);
  EXPECT_NEAR(contacts[0].force_N.norm(), kForce_N, 0.1 * kForce_N);
  EXPECT_GT(contacts[0].ci95_N, kForce_N);
}

TEST_F(HiddenContactByPlace, IsLeftOutAndFollowedWhereItsPlaceLeavesAWeakForceOpen) {
  constexpr double kWeak_N = 0.01;
  EXPECT_EQ(report_.WithoutContacts(fit_).code(), StatusCode::kNoContact);
  ASSERT_NO_FATAL_FAILURE(Follow(kWeak_N, kWeak_N));
  EXPECT_TRUE(report_.HoldsZero(fit_, 0));
  EXPECT_TRUE(report_.Contacts(fit_).empty());
  EXPECT_EQ(report_.WithoutContacts(fit_).code(), StatusCode::kUnobservable);
}

/// An image then shows what pushes there.
TEST_F(HiddenContactByPlace, IsReportedAsSeenOnceItIsSeen) {
  ASSERT_NO_FATAL_FAILURE(Follow(0.5 * kForce_N));
  Fit(SeenFrameOf(Solve(kForce_N)));
  report_.Judge(t_s_, false, &fit_);
  ASSERT_EQ(fit_.sites().size(), 1u) << "it is the hidden one";
  const std::vector<ContactForce> contacts = report_.Contacts(fit_);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].name, "finger");
  EXPECT_NE(contacts[0].status.code(), StatusCode::kHidden);
}

/// One that nobody sees, held still: the squares of its interval and of its error, m^2, in the
/// first frame and after seven.
class HeldContact : public Contacts {
 public:
  HeldContact(unsigned seed, float noise) : Contacts(seed, noise) {}

  void Follow() {
    const fem::StaticState pushed = Solve(kForce_N);
    for (int k = 0; k < 7; ++k) {
      const ShapeFrame frame = FrameOf(pushed);
      Fit(frame);
      ASSERT_TRUE(hidden_.Find(frame, bias_).ok());
      report_.Judge(t_s_, false, &fit_);
      ASSERT_EQ(fit_.sites().size(), 1u);
      const ShapeSite& site = fit_.sites()[0];
      const double off_m = (site.centre.rest_m - place_m_).norm();
      last_m2 = {std::pow(site.place_ci95_m, 2), std::pow(off_m, 2)};
      if (k == 0) first_m2 = last_m2;
      EXPECT_LE(off_m, site.place_ci95_m) << k;
    }
  }

  Eigen::Vector2d first_m2, last_m2;

 private:
  void TestBody() override {}
};

/// All frames in which a contact holds still tell its place, not the last one alone. Noise of five
/// times the camera's, so that it outweighs the depth bias, which frames share.
TEST(HiddenContactsHeld, ArePlacedBetterTheLongerTheyHold) {
  constexpr float kNoise = 5.0f;
  Eigen::Vector2d first_m2 = Eigen::Vector2d::Zero();
  Eigen::Vector2d last_m2 = Eigen::Vector2d::Zero();
  for (unsigned seed = 1; seed <= 4; ++seed) {
    HeldContact held(seed, kNoise);
    ASSERT_NO_FATAL_FAILURE(held.Follow());
    first_m2 += held.first_m2;
    last_m2 += held.last_m2;
  }
  EXPECT_LT(last_m2[0], first_m2[0]);
  EXPECT_LT(last_m2[1], first_m2[1]);
}

/// The responses about a new factor, which the frame after the one that found the contact wants,
/// are solved for once that frame is done, and no more than once.
TEST_F(Contacts, ThatNobodySeesAreFollowedByResponsesFromBetweenFrames) {
  const ShapeFrame frame = FrameOf(Solve(kForce_N));
  fit_.BeginFrame(/*whole=*/false);
  Fit(frame);
  ASSERT_TRUE(hidden_.Find(frame, bias_).ok());
  ASSERT_EQ(fit_.sites().size(), 1u);
  const fem::TimeBudget work = fit_.fitter().BudgetOfWork(std::numeric_limits<double>::infinity());
  hidden_.PrepareNext(cables_);
  const double first = work.Elapsed_s();
  EXPECT_GT(first, 0.0);
  hidden_.PrepareNext(cables_);
  EXPECT_EQ(work.Elapsed_s(), first);
}

TEST_F(Contacts, OfAnotherMakingAreNotSoughtWhereOneIsSeen) {
  const ShapeFrame frame = SeenFrameOf(Solve(kForce_N));
  for (int k = 0; k < 3; ++k) {
    Fit(frame);
    ASSERT_TRUE(hidden_.Find(frame, bias_).ok());
  }
  ASSERT_EQ(fit_.sites().size(), 1u);
  EXPECT_FALSE(fit_.sites()[0].hidden);
}

/// As many can go out of sight at once as can be seen.
TEST_F(Contacts, ThreeThatNobodySeesAreFollowedTogether) {
  constexpr double kEach_N = 0.8;
  const std::vector<Eigen::Vector3d> places_m = {
      place_m_, {-0.082, -0.002, 0.054}, {0.082, 0.002, 0.054}};
  std::vector<robot::DeadLoad> loads;
  std::vector<HiddenContact> there;
  for (const Eigen::Vector3d& place_m : places_m) {
    const fem::SurfacePatch patch = scene_.model->Patch(place_m, shape_.contact_radius_m);
    loads.push_back({patch.weights, -kEach_N * patch.normal});
    there.push_back({.rest_position_m = place_m, .normal = patch.normal, .force_N = kEach_N});
  }
  fem::StaticState pushed = scene_.model->RestState();
  ASSERT_TRUE(scene_.model->Solve(cables_, loads, &pushed).status.ok());
  fit_.tracks().ReplaceHidden(there);
  for (int k = 0; k < 3; ++k) {
    const ShapeFrame frame = FrameOf(pushed);
    Fit(frame);
    ASSERT_TRUE(hidden_.Find(frame, bias_).ok());
    ASSERT_EQ(fit_.sites().size(), 3u);
  }
  for (std::size_t c = 0; c < there.size(); ++c) {
    EXPECT_LT((fit_.sites()[c].centre.rest_m - places_m[c]).norm(), 0.02) << c;
    EXPECT_NEAR(fit_.ForceAt(c).norm(), kEach_N, 0.5 * kEach_N) << c;
  }
}

/// What a contact that went out of sight leaves behind goes on, but not into another recording.
TEST_F(Contacts, FromBeforeAGapInTimeAreForgotten) {
  ShapeForceEstimator estimator(*scene_.model, Config(), shape_);
  for (int k = 0; k < 6; ++k) {
    ShapeFrame frame = FrameOf(free_);
    frame.untouched = true;
    estimator.Update(frame);
  }
  const fem::StaticState pushed = Solve(kForce_N);
  for (int k = 0; k < 3; ++k) estimator.Update(SeenFrameOf(pushed));
  ASSERT_EQ(estimator.Update(SeenFrameOf(pushed)).contacts.size(), 1u);
  EXPECT_EQ(estimator.Update(FrameOf(pushed)).contacts.front().name, "hidden_1");
  t_s_ += 10.0;
  EXPECT_TRUE(estimator.Update(FrameOf(free_)).contacts.empty());
  ShapeFrame another = FrameOf(pushed);
  another.epoch = 1;
  const ForceEstimate& found = estimator.Update(another);
  ASSERT_EQ(found.contacts.size(), 1u) << "it was there when the sequence began";
  EXPECT_NE(found.contacts.front().name, "hidden_1");
  EXPECT_NEAR(found.contacts.front().force_N.norm(), kForce_N, found.contacts.front().ci95_N);
}

/// The first frames of a sequence take seconds where the body is bent far. If the next frame, which
/// is that much later, began another sequence, no contact would ever be followed.
TEST_F(Contacts, AreFollowedWhereEachFrameTakesSeconds) {
  ShapeForceEstimator estimator(*scene_.model, Config(), shape_);
  for (int k = 0; k < 6; ++k) {
    ShapeFrame frame = FrameOf(free_);
    frame.untouched = true;
    estimator.Update(frame);
  }
  const fem::StaticState pushed = Solve(kForce_N);
  const auto after = [&](double passed_s, const ShapeFrame& frame) {
    ShapeFrame later = frame;
    later.t_s = (t_s_ += passed_s);
    return estimator.Update(later);
  };
  for (int k = 0; k < 3; ++k) after(2.0, SeenFrameOf(pushed));
  const ForceEstimate lost = after(2.0, FrameOf(pushed));
  ASSERT_EQ(lost.contacts.size(), 1u);
  const ForceEstimate next = after(2.0, FrameOf(pushed));
  ASSERT_EQ(next.contacts.size(), 1u);
  EXPECT_EQ(next.contacts.front().name, lost.contacts.front().name);
}

}  // namespace
}  // namespace palpate::force_estimation
