// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/frame_collector.hpp"

#include <gtest/gtest.h>

#include "tests/components/force_estimation/node/test_robot.hpp"

namespace palpate::calibration {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

class FrameCollectorTest : public testing::Test {
 protected:
  /// The cable from `begin_ms` to `end_ms`.
  void Read(int begin_ms, int end_ms, double displacement_m) {
    for (int t_ms = begin_ms; t_ms <= end_ms; t_ms += 10) {
      collector_.Add(CableReading{t_ms * kMillisecond_ns, {{displacement_m, std::nullopt}}});
    }
  }
  void SeeMarker(int t_ms, double x_m, double sigma_m = 1e-3, int marker = 1) {
    SeenMarkers seen{t_ms * kMillisecond_ns, {}};
    seen.markers.push_back({.marker = marker,
                            .position_m = {x_m, 0.0, 0.0},
                            .covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
    collector_.Add(std::move(seen));
  }
  void SeeCloud(int t_ms, int width_px = 0) {
    collector_.Add(SeenCloud{t_ms * kMillisecond_ns, {}, {.width_px = width_px, .height_px = 480}});
  }

  std::unique_ptr<robot::RobotModel> robot_ = force_estimation::NodeTestRobot();
  FrameCollector collector_{
      *robot_, {.rest = {.still_s = 0.1}, .marker_pictures = 4, .marker_bias_m = 2e-3}};
};

TEST_F(FrameCollectorTest, WaitsForTheCableReadingsOfAPicture) {
  collector_.Begin(1);
  SeeCloud(200);
  EXPECT_EQ(collector_.taken(), 0);
  EXPECT_NE(collector_.waits_for().find("/robot/joint_states"), std::string::npos);
  Read(0, 300, 1e-3);
  EXPECT_TRUE(collector_.IsComplete());
  EXPECT_EQ(collector_.clouds().at(0).gravity_m_s2, robot_->gravity_m_s2());
}

TEST_F(FrameCollectorTest, TellsThePictureThatAllCloudsAreFrom) {
  Read(0, 300, 1e-3);
  Read(400, 700, 5e-3);
  for (const int second_px : {848, 640}) {
    collector_.Begin(2);
    EXPECT_FALSE(collector_.picture());
    SeeCloud(200, 848);
    SeeCloud(600, second_px);
    ASSERT_TRUE(collector_.IsComplete());
    EXPECT_EQ(collector_.picture().has_value(), second_px == 848);
  }
  collector_.Begin(1);
  SeeCloud(600, 0);
  ASSERT_TRUE(collector_.IsComplete());
  EXPECT_FALSE(collector_.picture()) << "perception does not say";
}

TEST_F(FrameCollectorTest, AveragesMarkersOfOneRestAndSaysHowWellTheyAreKnown) {
  Read(0, 300, 1e-3);
  collector_.Begin(1);
  for (const int t_ms : {200, 210, 220, 230}) SeeMarker(t_ms, 0.1);
  ASSERT_TRUE(collector_.IsComplete());
  const MarkerSighting& mean = collector_.markers().at(0).markers.at(0);
  EXPECT_EQ(mean.marker, 1);
  EXPECT_NEAR(mean.position_m.x(), 0.1, 1e-15);
  EXPECT_NEAR(mean.covariance_m2(0, 0), 1e-6 / 4.0 + 4e-6, 1e-12);
}

TEST_F(FrameCollectorTest, MarkersThatVaryByMoreThanTheySayAreKnownTheWorse) {
  Read(0, 300, 1e-3);
  collector_.Begin(1);
  for (const int k : {-1, 1, -1, 1}) SeeMarker(200 + k, 0.1 + 6e-3 * k);
  ASSERT_TRUE(collector_.IsComplete());
  const Eigen::Matrix3d& covariance_m2 = collector_.markers()[0].markers[0].covariance_m2;
  EXPECT_NEAR(covariance_m2(0, 0), 36e-6 / 3.0 + 4e-6, 1e-12);
  EXPECT_NEAR(covariance_m2(1, 1), 1e-6 / 4.0 + 4e-6, 1e-12);
}

TEST_F(FrameCollectorTest, MarkersWithoutNamesAreKeptApartAndNotMixedWithOthers) {
  Read(0, 300, 1e-3);
  Read(400, 700, 5e-3);
  collector_.Begin(2);
  for (const int k : {0, 1, 2, 3}) SeeMarker(200 + k, 0.1, 1e-3, -1);
  ASSERT_EQ(collector_.points().size(), 1u);
  EXPECT_EQ(collector_.points()[0].points.at(0).marker, -1);
  EXPECT_NEAR(collector_.points()[0].frame.cables.at(0).value, 1e-3, 1e-15);
  for (const int k : {0, 1, 2, 3}) SeeMarker(600 + k, 0.1);
  EXPECT_EQ(collector_.taken(), 1);
  EXPECT_NE(collector_.waits_for().find("those of earlier frames had none"), std::string::npos);
  for (const int k : {4, 5, 6, 7}) SeeMarker(600 + k, 0.1, 1e-3, -1);
  EXPECT_TRUE(collector_.IsComplete());
  EXPECT_TRUE(collector_.markers().empty());
  collector_.Begin(1);
  EXPECT_TRUE(collector_.points().empty());
}

TEST_F(FrameCollectorTest, AMotionBeginsTheMeanAnew) {
  Read(0, 300, 1e-3);
  Read(310, 600, 3e-3);
  collector_.Begin(1);
  for (const int t_ms : {270, 280, 290}) SeeMarker(t_ms, 0.1);
  SeeMarker(350, 0.2);  // on the way
  for (const int t_ms : {500, 510, 520}) SeeMarker(t_ms, 0.3);
  EXPECT_EQ(collector_.taken(), 0);
  SeeMarker(530, 0.3);
  ASSERT_TRUE(collector_.IsComplete());
  EXPECT_NEAR(collector_.markers()[0].markers[0].position_m.x(), 0.3, 1e-15);
  EXPECT_NEAR(collector_.markers()[0].cables.at(0).value, 3e-3, 1e-15);
}

TEST_F(FrameCollectorTest, TakesNothingUntilItIsAskedAndForgetsWhenAskedAnew) {
  Read(0, 300, 1e-3);
  SeeCloud(200);
  EXPECT_EQ(collector_.taken(), 0);
  collector_.Begin(2);
  SeeCloud(210);
  EXPECT_EQ(collector_.taken(), 1);
  SeeCloud(220);  // of the same setting
  EXPECT_EQ(collector_.taken(), 1);
  collector_.Begin(2);
  EXPECT_EQ(collector_.taken(), 0);
  SeeCloud(230);
  EXPECT_EQ(collector_.taken(), 1);
}

}  // namespace
}  // namespace palpate::calibration
