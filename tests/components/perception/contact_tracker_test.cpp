// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/contact_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "components/perception/contacts/assignment.hpp"

namespace palpate::perception {
namespace {

using Names = std::vector<std::string>;

DetectedContact At(double x_m, double y_m = 0.0) {
  DetectedContact contact;
  contact.position_m = {x_m, y_m, 0.45};
  contact.covariance_m2 = 1e-6 * Eigen::Matrix3d::Identity();
  contact.extent_m = {0.004, 0.002, 0.001};
  contact.point_count = 10;
  return contact;
}

Names NamesOf(const std::vector<DetectedContact>& contacts) {
  Names names;
  for (const DetectedContact& contact : contacts) names.push_back(contact.name);
  return names;
}

TEST(ContactTracker, WhatTheFirstFrameShowsIsThereAtOnce) {
  ContactTracker tracker({.appear_frames = 3, .vanish_frames = 2});
  EXPECT_EQ(NamesOf(tracker.Update({At(0.0)})), Names{"contact_1"});
  EXPECT_EQ(NamesOf(tracker.Update({At(0.0), At(0.1)})), Names{"contact_1"});
  tracker.Forget();
  EXPECT_EQ(NamesOf(tracker.Update({At(0.0), At(0.1)})), (Names{"contact_2", "contact_3"}));
}

/// The shape that the first frame is segmented by is a guess.
TEST(ContactTracker, WhatIsMissingSoonAfterTheFirstFrameVanishesAtOnce) {
  ContactTracker tracker({.appear_frames = 3, .vanish_frames = 3});
  EXPECT_EQ(NamesOf(tracker.Update({At(0.0), At(0.1)})), (Names{"contact_1", "contact_2"}));
  EXPECT_EQ(NamesOf(tracker.Update({At(0.1)})), Names{"contact_2"});
  EXPECT_EQ(NamesOf(tracker.Update({At(0.1)})), Names{"contact_2"});
  EXPECT_EQ(NamesOf(tracker.Update({})), Names{"contact_2"});
}

TEST(ContactTracker, AppearsAndVanishesAfterExactlySoManyFrames) {
  for (const auto& [appear, vanish] : {std::pair(1, 1), std::pair(3, 2), std::pair(5, 7)}) {
    ContactTracker tracker({.appear_frames = appear, .vanish_frames = vanish});
    tracker.Update({});
    for (int frame = 1; frame <= appear + 2; ++frame) {
      const auto& contacts = tracker.Update({At(0.0)});
      ASSERT_EQ(contacts.size(), frame >= appear ? 1u : 0u) << frame;
      if (!contacts.empty()) {
        EXPECT_EQ(contacts[0].frames_seen, frame);
      }
    }
    for (int frame = 1; frame <= vanish + 2; ++frame) {
      const auto& contacts = tracker.Update({});
      ASSERT_EQ(contacts.size(), frame < vanish ? 1u : 0u) << frame;
      if (!contacts.empty()) {
        EXPECT_EQ(contacts[0].frames_seen, 0);
      }
    }
  }
}

TEST(ContactTracker, OneMissingFrameBeforeItAppearsBeginsTheCountAnew) {
  ContactTracker tracker({.appear_frames = 3, .vanish_frames = 3});
  tracker.Update({});
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(tracker.Update({At(0.0)}).empty());
    EXPECT_TRUE(tracker.Update({At(0.0)}).empty());
    EXPECT_TRUE(tracker.Update({}).empty());
  }
}

TEST(ContactTracker, NamesAreNeverGivenTwice) {
  ContactTracker tracker({.appear_frames = 1, .vanish_frames = 1});
  EXPECT_EQ(NamesOf(tracker.Update({At(0.0)})), Names{"contact_1"});
  EXPECT_TRUE(tracker.Update({}).empty());
  EXPECT_EQ(NamesOf(tracker.Update({At(0.0)})), Names{"contact_2"});
  EXPECT_EQ(NamesOf(tracker.Update({At(0.1)})), Names{"contact_3"});  // beyond the gate
  tracker.Forget();
  EXPECT_EQ(NamesOf(tracker.Update({At(0.1)})), Names{"contact_4"});
}

TEST(ContactTracker, TwentyContactsKeepTheirNamesWithNoiseAndDropOuts) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise_m(0.0, 0.002);
  ContactTracker tracker({});
  std::vector<DetectedContact> places;
  for (int k = 0; k < 20; ++k) places.push_back(At(0.025 * (k % 5), 0.025 * (k / 5)));
  tracker.Update(places);
  tracker.Update(places);
  const std::vector<DetectedContact> first = tracker.Update(places);
  ASSERT_EQ(first.size(), 20u);
  EXPECT_EQ(first.front().name, "contact_1");
  EXPECT_EQ(first.back().name, "contact_20");
  for (int frame = 0; frame < 200; ++frame) {
    std::vector<DetectedContact> detected;
    for (int k = 0; k < 20; ++k) {
      if ((frame + 3 * k) % 17 < 2) continue;  // two frames in a row
      DetectedContact contact = places[static_cast<std::size_t>(k)];
      contact.position_m += Eigen::Vector3d(noise_m(random), noise_m(random), noise_m(random));
      detected.push_back(contact);
    }
    std::shuffle(detected.begin(), detected.end(), random);
    const auto& contacts = tracker.Update(detected);
    ASSERT_EQ(NamesOf(contacts), NamesOf(first)) << frame;
    for (std::size_t k = 0; k < 20; ++k) {
      EXPECT_LT((contacts[k].position_m - first[k].position_m).norm(), 0.0125) << frame;
    }
  }
}

TEST(ContactTracker, ContactsThatPassEachOtherAndThoseThatMoveTogetherKeepTheirNames) {
  ContactTracker tracker({.gate_m = 0.02, .appear_frames = 1, .smoothing = 0.0});
  // Towards each other, 8 mm apart when they pass.
  for (int frame = 0; frame <= 20; ++frame) {
    const double x_m = -0.04 + 0.004 * frame;
    const auto& contacts = tracker.Update({At(-x_m, 0.008), At(x_m, 0.0)});
    ASSERT_EQ(NamesOf(contacts), (Names{"contact_1", "contact_2"}));
    EXPECT_DOUBLE_EQ(contacts[0].position_m.y(), 0.008);
  }
  // Both by nearly the distance between them: the nearest pair would be the wrong one.
  tracker.Forget();
  tracker.Update({At(0.0), At(0.010)});
  const auto& contacts = tracker.Update({At(0.018), At(0.008)});
  ASSERT_EQ(NamesOf(contacts), (Names{"contact_3", "contact_4"}));
  EXPECT_DOUBLE_EQ(contacts[0].position_m.x(), 0.008);
}

TEST(ContactTracker, OfTwoThatMergeOneStaysAndTheOtherVanishes) {
  ContactTracker tracker({.gate_m = 0.02, .appear_frames = 2, .vanish_frames = 3});
  for (int frame = 0; frame < 3; ++frame) tracker.Update({At(-0.006), At(0.006)});
  // One in the middle, now a little nearer to the one, now to the other.
  for (int frame = 0; frame < 10; ++frame) {
    const auto& contacts = tracker.Update({At(frame % 2 == 0 ? 0.001 : -0.001)});
    ASSERT_EQ(contacts.size(), frame < 2 ? 2u : 1u) << frame;
    EXPECT_EQ(std::count_if(contacts.begin(), contacts.end(),
                            [](const auto& contact) { return contact.frames_seen > 0; }),
              1);
    EXPECT_EQ(contacts.back().name, "contact_2");  // nearer in the first of these frames
  }
  // They part again: the one has a new name.
  tracker.Update({At(-0.006), At(0.006)});
  EXPECT_EQ(NamesOf(tracker.Update({At(-0.006), At(0.006)})), (Names{"contact_2", "contact_3"}));
}

TEST(ContactTracker, OfTwoThatMergeForAMomentBothKeepTheirNames) {
  ContactTracker tracker({.gate_m = 0.02, .appear_frames = 1, .vanish_frames = 3});
  tracker.Update({At(-0.006), At(0.006)});
  tracker.Update({At(0.0)});
  tracker.Update({At(0.0)});
  const auto& contacts = tracker.Update({At(-0.006), At(0.006)});
  ASSERT_EQ(NamesOf(contacts), (Names{"contact_1", "contact_2"}));
  EXPECT_LT(contacts[0].position_m.x(), contacts[1].position_m.x());
}

TEST(ContactTracker, SmoothingKeepsItsShareOfTheLastPlaceAndSaysSo) {
  ContactTracker tracker({.appear_frames = 1, .smoothing = 0.25});
  tracker.Update({At(0.0)});
  const auto& contacts = tracker.Update({At(0.008)});
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].position_m.x(), 0.006, 1e-15);
  EXPECT_NEAR(contacts[0].covariance_m2(0, 0), 1e-6 + 0.25 * 0.75 * 0.008 * 0.008, 1e-15);
  EXPECT_NEAR(contacts[0].covariance_m2(1, 1), 1e-6, 1e-15);
  // It comes to rest on what is seen.
  for (int frame = 0; frame < 30; ++frame) tracker.Update({At(0.008)});
  EXPECT_NEAR(contacts[0].position_m.x(), 0.008, 1e-12);
}

TEST(AssignRows, TheSumIsTheLeastOfAllAssignments) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const int rows = 1 + trial % 5;
    const int columns = rows + trial % 3;
    const Eigen::MatrixXd cost =
        Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return any(random); });
    const std::vector<int> assigned = AssignRows(cost);
    double sum = 0.0;
    for (int row = 0; row < rows; ++row) sum += cost(row, assigned[static_cast<std::size_t>(row)]);
    std::vector<int> order(static_cast<std::size_t>(columns));
    for (int column = 0; column < columns; ++column)
      order[static_cast<std::size_t>(column)] = column;
    double least = 1e9;
    do {
      double other = 0.0;
      for (int row = 0; row < rows; ++row) other += cost(row, order[static_cast<std::size_t>(row)]);
      least = std::min(least, other);
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(sum, least, 1e-12);
    std::vector<int> distinct = assigned;
    std::sort(distinct.begin(), distinct.end());
    EXPECT_EQ(std::unique(distinct.begin(), distinct.end()), distinct.end());
  }
  EXPECT_TRUE(AssignRows(Eigen::MatrixXd(0, 3)).empty());
}

}  // namespace
}  // namespace palpate::perception
