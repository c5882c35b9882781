// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/joint_perception.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <utility>

#include "tests/components/perception/contact_scene.hpp"

namespace palpate::perception {
namespace {

using test::SampleAll;

/// Gives what the test puts into `next`.
class ScriptedFrames : public Segmenter {
 public:
  explicit ScriptedFrames(const SegmentedFrame* next) : next_(next) {}
  void SetCamera(const rgbd::RgbdCamera&) override {}
  const SegmentedFrame& Segment(const rgbd::RgbdFrame&, const PredictedSurface*) override {
    return *next_;
  }

 private:
  const SegmentedFrame* next_;
};

SegmentedFrame TouchedAt(std::vector<Eigen::Vector2d> touch_m) {
  SegmentedFrame frame;
  auto clouds = SampleAll({.plate_half_m = 0.05, .touch_m = std::move(touch_m)}, 0.002);
  frame.status = Status::Ok();
  frame.robot = std::move(clouds.robot);
  frame.object = std::move(clouds.object);
  return frame;
}

/// Two cameras before a plate, the second turned by half a turn about the plate's normal.
class TwoCameras : public testing::Test {
 protected:
  TwoCameras() {
    T_second_.linear() = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
    perception_.Open({rgbd::RgbdCamera{}, rgbd::RgbdCamera{}});
  }

  const JointObservation& Update(bool first = true, bool second = true) {
    return perception_.Update(++stamp_ns_, {{.images = first ? &images_ : nullptr},
                                            {.images = second ? &images_ : nullptr,
                                             .predicted = nullptr,
                                             .T_robot_camera = T_second_}});
  }

  SegmentedFrame seen_[2] = {TouchedAt({}), TouchedAt({})};
  std::size_t made_ = 0;
  JointPerception perception_{Config{}, [this](const Config&) {
                                return std::make_unique<ScriptedFrames>(&seen_[made_++]);
                              }};
  rgbd::RgbdFrame images_;
  Eigen::Isometry3d T_second_ = Eigen::Isometry3d::Identity();
  std::int64_t stamp_ns_ = 0;
};

TEST_F(TwoCameras, AContactOfTheSecondIsInTheFrameOfTheFirst) {
  seen_[1] = TouchedAt({{-0.02, -0.01}});
  const std::vector<DetectedContact> second = Update().contacts;
  ASSERT_EQ(second.size(), 1u);
  seen_[0] = seen_[1];
  perception_.Open({rgbd::RgbdCamera{}, rgbd::RgbdCamera{}});
  const std::vector<DetectedContact>& first = Update(true, /*second=*/false).contacts;
  ASSERT_EQ(first.size(), 1u);
  EXPECT_TRUE(second[0].position_m.isApprox(T_second_ * first[0].position_m));
  const Eigen::Matrix3d R_second = T_second_.linear();
  EXPECT_TRUE(
      second[0].covariance_m2.isApprox(R_second * first[0].covariance_m2 * R_second.transpose()));
}

TEST_F(TwoCameras, AContactThatBothSeeIsOneBetweenWhatEachSees) {
  seen_[0] = TouchedAt({{0.02, 0.01}});
  seen_[1] = TouchedAt({{-0.02, -0.01}});
  const Eigen::Vector3d first_m = Update(true, false).contacts.at(0).position_m;
  perception_.Open({rgbd::RgbdCamera{}, rgbd::RgbdCamera{}});
  const Eigen::Vector3d second_m = Update(false, true).contacts.at(0).position_m;
  perception_.Open({rgbd::RgbdCamera{}, rgbd::RgbdCamera{}});
  const JointObservation& seen = Update();
  ASSERT_EQ(seen.contacts.size(), 1u);
  const double apart_m = (first_m - second_m).norm();
  EXPECT_LE((seen.contacts[0].position_m - first_m).norm(), apart_m + 1e-9);
  EXPECT_LE((seen.contacts[0].position_m - second_m).norm(), apart_m + 1e-9);
}

TEST_F(TwoCameras, ContactsAtTwoPlacesAreTwo) {
  seen_[0] = TouchedAt({{0.02, 0.01}});
  seen_[1] = TouchedAt({{0.02, 0.01}});
  EXPECT_EQ(Update().contacts.size(), 2u);
}

TEST_F(TwoCameras, AContactKeepsItsNameWhicheverCameraSeesIt) {
  seen_[0] = TouchedAt({{0.02, 0.01}});
  seen_[1] = TouchedAt({{-0.02, -0.01}});
  const std::string name = Update().contacts.at(0).name;
  for (int k = 0; k < 5; ++k) {
    const JointObservation& seen = Update(/*first=*/k % 2 == 0, /*second=*/k % 2 == 1);
    ASSERT_EQ(seen.contacts.size(), 1u);
    EXPECT_EQ(seen.contacts[0].name, name);
    EXPECT_GT(seen.contacts[0].frames_seen, 0);
  }
}

TEST_F(TwoCameras, AMissingCameraHasAnEmptyViewThatSaysSo) {
  const JointObservation& seen = Update(/*first=*/false);
  EXPECT_EQ(seen.views[0].frame.status.code(), StatusCode::kStale);
  EXPECT_EQ(seen.views[0].frame.robot.Count(), 0);
  EXPECT_TRUE(seen.status().ok());
  EXPECT_GT(seen.views[1].frame.robot.Count(), 0);
}

TEST(JoinContacts, OfUnlikeCertaintyIsThatOfTheCertainOne) {
  DetectedContact vague, certain;
  vague.position_m = {0.0, 0.0, 0.4};
  vague.covariance_m2 = 1e-4 * Eigen::Matrix3d::Identity();
  certain.position_m = {0.004, 0.0, 0.4};
  certain.covariance_m2 = 1e-6 * Eigen::Matrix3d::Identity();
  std::vector<DetectedContact> contacts = {vague};
  JoinContacts({certain}, &contacts);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].position_m, certain.position_m);
  EXPECT_EQ(contacts[0].covariance_m2, certain.covariance_m2);
}

/// Each camera is certain across its own line of sight.
TEST(JoinContacts, WhatEachCameraKnowsBestCounts) {
  DetectedContact along_x, along_y;
  along_x.covariance_m2 = Eigen::Vector3d(1e-6, 25e-6, 1e-6).asDiagonal();
  along_y.covariance_m2 = Eigen::Vector3d(25e-6, 1e-6, 1e-6).asDiagonal();
  along_y.position_m = {0.005, 0.005, 0.0};
  std::vector<DetectedContact> contacts = {along_x};
  JoinContacts({along_y}, &contacts);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_LT(contacts[0].position_m.x(), 0.5e-3);
  EXPECT_GT(contacts[0].position_m.y(), 4.5e-3);
  EXPECT_LT(contacts[0].covariance_m2.trace(), along_x.covariance_m2.trace());
}

}  // namespace
}  // namespace palpate::perception
