// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <numeric>
#include <random>

#include "libs/geometry/pose_text.hpp"
#include "tests/components/calibration/node/node_fixture.hpp"

/// A live calibration from fiducials of one colour: /perception/markers has no names.
namespace palpate::calibration {
namespace {

using ::testing::HasSubstr;

std::unique_ptr<robot::RobotModel> Marked(const std::vector<Eigen::Vector3d>& places_m) {
  robot::RobotDescription description = force_estimation::NodeTestDescription();
  description.markers.clear();
  for (const Eigen::Vector3d& place_m : places_m) {
    description.markers.push_back({"m" + std::to_string(description.markers.size()), place_m, {}});
  }
  return std::make_unique<robot::RobotModel>(robot::BuildRobotBody(description));
}

/// No turn of which looks like another.
std::unique_ptr<robot::RobotModel> Eight() {
  return Marked({{-0.005, 0.010, 0.030},
                 {-0.012, 0.000, 0.021},
                 {-0.020, 0.030, 0.006},
                 {-0.034, 0.022, 0.030},
                 {-0.047, 0.000, 0.009},
                 {-0.058, 0.030, 0.024},
                 {-0.071, 0.007, 0.030},
                 {-0.083, 0.000, 0.014}});
}

class UnnamedMarkers : public CalibrationNodeTest {
 protected:
  explicit UnnamedMarkers(const RobotMaker& make_robot = Eight) : CalibrationNodeTest(make_robot) {
    send_names_ = false;
  }

  /// Each picture in an order of its own.
  void SendPoints(std::int64_t stamp_ns, double told_m, const Eigen::Matrix3Xd& points_m) {
    SendRest(stamp_ns, told_m);
    std::vector<Eigen::Index> order(static_cast<std::size_t>(points_m.cols()));
    std::iota(order.begin(), order.end(), 0);
    for (std::int64_t k = 3; k > 0; --k) {
      std::shuffle(order.begin(), order.end(), random_);
      SendMarkers(stamp_ns - k, points_m(Eigen::all, order));
    }
  }
  /// Three settings of all markers.
  void SendThree() {
    for (int k = 0; k < 3; ++k) SendPoints((k + 1) * kSecond_ns, 2e-3 * k, MarkersSeen(2e-3 * k));
  }
  void Begin(const NodeConfig& config) {
    StartNode(config, CalibrateLive);
    Ask({.frames = 3});
    WaitForState("one", "collecting");
  }
  void ExpectFound() {
    ASSERT_TRUE(test_.WaitFor([&] { return !found_.empty(); }));
    const robot::CalibrationFile& found = found_.back();
    ASSERT_TRUE(found.pose);
    EXPECT_TRUE(found.pose->T_robot_camera.isApprox(TruePose(), 1e-4));
    EXPECT_GT(found.pose->translation_error_m.minCoeff(), 0.0);
    ASSERT_EQ(found.drives.size(), 1u);
    EXPECT_NEAR(found.drives[0].drive.offset_m, kOffset_m, 1e-5);
    EXPECT_TRUE(robot::CheckCalibration(found, *robot_).ok());
  }
  void ExpectFailure(const std::string& reason) {
    const Told failed = WaitForState("one", "failed");
    EXPECT_EQ(failed.status, "unobservable");
    EXPECT_THAT(failed.reason, HasSubstr(reason));
    EXPECT_TRUE(found_.empty());
  }

  std::mt19937 random_{20261122};
};

TEST_F(UnnamedMarkers, AreToldApartByWhereTheyAreWithMissingAndFalseOnes) {
  Begin(TestConfig());
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix3Xd points_m = MarkersSeen(2e-3 * k);
    points_m.col(2 * k) = TruePose().inverse() * Eigen::Vector3d(-0.06, 0.09, 0.05);  // is none
    SendPoints((k + 1) * kSecond_ns, 2e-3 * k, points_m.leftCols(7));
  }
  EXPECT_EQ(WaitForState("one", "done").reason, "");
  ExpectFound();
}

TEST_F(UnnamedMarkers, APictureThatDoesNotFitIsLeftOutAndNamed) {
  Begin(TestConfig());
  SendPoints(1 * kSecond_ns, 0.0, MarkersSeen(0.0));
  SendPoints(2 * kSecond_ns, 2e-3, MarkersSeen(2e-3).leftCols(4));
  SendPoints(3 * kSecond_ns, 4e-3, MarkersSeen(4e-3));
  EXPECT_THAT(WaitForState("one", "done").reason,
              HasSubstr("without frame 2: an assignment needs 5 points, there are 4"));
  ExpectFound();
}

TEST_F(UnnamedMarkers, TooFewOfThemAreRefused) {
  Begin(TestConfig());
  for (int k = 0; k < 3; ++k) {
    SendPoints((k + 1) * kSecond_ns, 2e-3 * k, MarkersSeen(2e-3 * k).leftCols(4));
  }
  ExpectFailure("an assignment needs 5 points, there are 4");
}

/// Two rings round the beam at its clamp, which look the same after quarter turns: what the cable
/// does to them is less than they are known to.
class MarkersThatLookAlike : public UnnamedMarkers {
 protected:
  MarkersThatLookAlike() : UnnamedMarkers(Rings) { marker_sigma_m_ = 1e-3; }

  static std::unique_ptr<robot::RobotModel> Rings() {
    std::vector<Eigen::Vector3d> places_m;
    for (const double x_m : {-0.097, -0.085}) {
      for (const auto& [y_m, z_m] : {std::pair(0.015, 0.0), std::pair(0.03, 0.015),
                                     std::pair(0.015, 0.03), std::pair(0.0, 0.015)}) {
        places_m.emplace_back(x_m, y_m, z_m);
      }
    }
    return Marked(places_m);
  }
};

TEST_F(MarkersThatLookAlike, AreRefusedWithTheReason) {
  Begin(TestConfig());
  SendThree();
  ExpectFailure("ambiguous: two assignments of the markers");
}

TEST_F(MarkersThatLookAlike, AreToldByThePoseOfTheLastCalibration) {
  robot::CalibrationFile last = robot::DescribeForCalibration(*robot_);
  last.date_utc = "2026-11-22T00:00:00Z";
  last.data = "before";
  last.pose.emplace().T_robot_camera = TruePose();
  NodeConfig config = TestConfig();
  robot::WriteCalibrationFile(last, config.calibration_file);
  Begin(config);
  SendThree();
  EXPECT_THAT(WaitForState("one", "done").reason, HasSubstr("the pose of the last calibration"));
  ASSERT_TRUE(test_.WaitFor([&] { return found_.size() >= 2; }));
  const Eigen::Isometry3d& found = found_.back().pose->T_robot_camera;
  EXPECT_LT(Eigen::AngleAxisd(found.linear() * TruePose().linear().transpose()).angle(), 0.1);
}

TEST_F(MarkersThatLookAlike, AreToldByARoughPoseOfTheCamera) {
  NodeConfig config = TestConfig();
  Eigen::Isometry3d rough = TruePose();
  rough.translation() += Eigen::Vector3d(0.01, -0.02, 0.01);
  config.camera_pose = geometry::FormatPose(
      rough * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1.0, 1.0, 0.0).normalized()));
  Begin(config);
  SendThree();
  WaitForState("one", "done");
  ASSERT_TRUE(test_.WaitFor([&] { return !found_.empty(); }));
  // They do not tell the actuator's zero, and the pose goes with it: not by a quarter turn.
  const Eigen::Isometry3d& found = found_.back().pose->T_robot_camera;
  EXPECT_LT(Eigen::AngleAxisd(found.linear() * TruePose().linear().transpose()).angle(), 0.1);
}

}  // namespace
}  // namespace palpate::calibration
