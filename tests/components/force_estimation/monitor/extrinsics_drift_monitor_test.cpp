// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/extrinsics_drift_monitor.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "libs/rgbd/surface_view.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {
namespace {

using State = DriftReport::State;
using Kind = robot::ActuatorCommand::Kind;

/// The four legs, as a stereo camera at 0.45 m sees them.
class DriftWatchTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    robot_ = std::make_unique<robot::RobotModel>(
        robot::BuildRobotBody(test_support::LinearFourLegRobot()));
    rest_ = Shape({}, 0.0);
  }
  static void TearDownTestSuite() { robot_.reset(); }

  DriftWatchTest() {
    const Eigen::Vector3d eye_m(0.343, -0.198, 0.275);
    const Eigen::Vector3d z = (Eigen::Vector3d(0.0, 0.0, 0.065) - eye_m).normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    T_robot_camera_.linear() << x, z.cross(x), z;
    T_robot_camera_.translation() = eye_m;
  }

  /// Equilibrium with each cable pulled so far, and a push along x on the hub.
  static Eigen::VectorXd Shape(const std::vector<double>& pulled_m, double push_N) {
    std::vector<robot::ActuatorCommand> cables(4);
    for (std::size_t c = 0; c < pulled_m.size(); ++c)
      cables[c] = {Kind::kDisplacement, pulled_m[c]};
    std::vector<robot::DeadLoad> loads;
    if (push_N > 0.0) {
      loads.push_back(
          {robot_->Patch({0.03, 0.0, 0.103}, 0.005).weights, Eigen::Vector3d(-push_N, 0.0, 0.0)});
    }
    fem::StaticState state = robot_->RestState();
    const auto result = robot_->Solve(cables, loads, &state);
    EXPECT_TRUE(result.status.ok()) << result.status.message();
    return state.x_m;
  }

  /// A picture of the robot from where the camera really stands, without noise.
  rgbd::SensedCloud Look(const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_robot_camera) {
    const rgbd::CameraModel camera{.width_px = 424,
                                   .height_px = 240,
                                   .fx_px = 212.0,
                                   .fy_px = 212.0,
                                   .cx_px = 211.5,
                                   .cy_px = 119.5};
    const Eigen::Map<const Eigen::Matrix3Xd> nodes_m(x_m.data(), 3, x_m.size() / 3);
    rgbd::SurfaceView view(camera);
    view.Look(T_robot_camera.inverse() * nodes_m, robot_->body().boundary.DrawnTriangles());
    std::vector<Eigen::Vector3f> points_m;
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        const float z_m = view.Z_m(u, v);
        if (z_m == 0.0f) continue;
        const Eigen::Vector3f point_m(z_m * static_cast<float>((u - camera.cx_px) / camera.fx_px),
                                      z_m * static_cast<float>((v - camera.cy_px) / camera.fy_px),
                                      z_m);
        // The rest says nothing, and takes the test's time.
        if (skin_.MayHold(T_robot_camera * point_m.cast<double>(), 0.02)) {
          points_m.push_back(point_m);
        }
      }
    }
    rgbd::SensedCloud cloud;
    cloud.points_m.resize(3, static_cast<Eigen::Index>(points_m.size()));
    for (std::size_t k = 0; k < points_m.size(); ++k) {
      cloud.points_m.col(static_cast<Eigen::Index>(k)) = points_m[k];
    }
    cloud.sigma_m = 1.5e-3f * (cloud.points_m.row(2) / 0.45f).cwiseAbs2().transpose();
    return cloud;
  }

  /// Noise along the lines of sight, alike in neighbours of a row of three.
  rgbd::SensedCloud Noisy(rgbd::SensedCloud cloud) {
    float share = 0.0f;
    for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
      if (k % 3 == 0) share = normal_(random_);
      cloud.points_m.col(k) *= 1.0f + share * cloud.sigma_m[k] / cloud.points_m(2, k);
    }
    return cloud;
  }

  /// So many seconds of pictures of `cloud`; whether the watch said "moved" at any time.
  bool Watch(const rgbd::SensedCloud& cloud, const Eigen::VectorXd& believed_m, double duration_s) {
    bool moved = false;
    for (const double end_s = t_s_ + duration_s; t_s_ < end_s; t_s_ += frame_period_s_) {
      watch_.Add(t_s_, SeeMotion(skin_, Noisy(cloud), T_robot_camera_, believed_m));
      moved = moved || watch_.report().state == State::kMoved;
    }
    return moved;
  }

  Eigen::Isometry3d Moved(const Eigen::Vector3d& shift_m,
                          const Eigen::Vector3d& turn_rad = Eigen::Vector3d::Zero()) const {
    Eigen::Isometry3d moved = T_robot_camera_;
    moved.translation() += shift_m;
    if (!turn_rad.isZero()) moved.rotate(Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()));
    return moved;
  }

  static std::unique_ptr<robot::RobotModel> robot_;
  static Eigen::VectorXd rest_;
  Eigen::Isometry3d T_robot_camera_ = Eigen::Isometry3d::Identity();
  FixedSurfaceRegion skin_{robot_->body()};
  ExtrinsicsDriftMonitor watch_;
  double t_s_ = 100.0;
  double frame_period_s_ = 0.1;
  std::mt19937 random_{7};
  std::normal_distribution<float> normal_;
};

std::unique_ptr<robot::RobotModel> DriftWatchTest::robot_;
Eigen::VectorXd DriftWatchTest::rest_;

TEST_F(DriftWatchTest, SaysNothingInTenMinutesOfNoise) {
  frame_period_s_ = 0.3;
  EXPECT_FALSE(Watch(Look(rest_, T_robot_camera_), rest_, 600.0)) << watch_.report().advice;
  EXPECT_EQ(watch_.report().state, State::kHolds);
}

TEST_F(DriftWatchTest, MeasuresTurnAndShift) {
  const Eigen::Vector3d shift_m(1e-3, -2e-3, 1.5e-3);
  const Eigen::Vector3d turn_rad(0.004, 0.003, -0.005);
  // What the camera, believed to stand still, sees of a body that moved the other way.
  const Eigen::Isometry3d seems = T_robot_camera_ * Moved(shift_m, turn_rad).inverse();
  const MotionSighting seen =
      SeeMotion(skin_, Look(rest_, Moved(shift_m, turn_rad)), T_robot_camera_, rest_);
  ASSERT_GT(seen.points, 100);
  const Eigen::Vector3d moved_m = seems * skin_.Middle_m() - skin_.Middle_m();
  const Eigen::AngleAxisd turn(seems.linear());
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(seen.motion[k], turn.angle() * turn.axis()[k], 1.5e-3) << k;
    EXPECT_NEAR(seen.motion[3 + k], moved_m[k], 3e-4) << k;
  }
}

TEST_F(DriftWatchTest, SaysWithinSecondsThatTheCameraMovedAndThatItIsBack) {
  for (int knock = 0; knock < 6; ++knock) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(knock % 3);
    const Eigen::Vector3d shift_m = (knock < 3 ? 2e-3 : 0.0) * unit;
    const Eigen::Vector3d turn_rad = (knock < 3 ? 0.0 : 5.2e-3) * unit;
    SCOPED_TRACE(testing::Message() << shift_m.transpose() << ", " << turn_rad.transpose());
    watch_ = ExtrinsicsDriftMonitor();
    EXPECT_FALSE(Watch(Look(rest_, T_robot_camera_), rest_, 7.0));
    EXPECT_TRUE(Watch(Look(rest_, Moved(shift_m, turn_rad)), rest_, 6.0));
    EXPECT_THAT(watch_.report().advice, testing::HasSubstr("calibrate again"));
    Watch(Look(rest_, T_robot_camera_), rest_, 6.0);
    EXPECT_EQ(watch_.report().state, State::kHolds);
  }
}

TEST_F(DriftWatchTest, ContactsThatNobodyKnowsAndCablesAreNoMotionOfTheCamera) {
  EXPECT_FALSE(Watch(Look(rest_, T_robot_camera_), rest_, 7.0));
  const Eigen::VectorXd pushed_m = Shape({}, 1.5);
  EXPECT_GT((pushed_m - rest_).cwiseAbs().maxCoeff(), 4e-3);
  EXPECT_FALSE(Watch(Look(pushed_m, T_robot_camera_), rest_, 7.0)) << watch_.report().advice;
  const Eigen::VectorXd bent_m = Shape({0.01, 0.002, 0.0, 0.004}, 0.0);
  EXPECT_GT((bent_m - rest_).cwiseAbs().maxCoeff(), 6e-3);
  EXPECT_FALSE(Watch(Look(bent_m, T_robot_camera_), bent_m, 7.0)) << watch_.report().advice;
  EXPECT_FALSE(Watch(Look(bent_m, T_robot_camera_), rest_, 7.0)) << watch_.report().advice;
}

TEST_F(DriftWatchTest, SaysSoWhereTheCameraStandsElsewhereFromTheStart) {
  EXPECT_FALSE(Watch(Look(rest_, Moved({1e-3, 0.0, 1e-3})), rest_, 7.0));
  watch_ = ExtrinsicsDriftMonitor();
  EXPECT_TRUE(Watch(Look(rest_, Moved({0.0, 5e-3, 0.0})), rest_, 7.0));
  EXPECT_THAT(watch_.report().advice, testing::HasSubstr("from where the calibration has it"));
}

TEST_F(DriftWatchTest, BeginsAnewWhereTimeGoesBackAndSaysWhereNothingIsSeen) {
  Watch(Look(rest_, T_robot_camera_), rest_, 7.0);
  EXPECT_TRUE(Watch(Look(rest_, Moved({2e-3, 0.0, 0.0})), rest_, 4.0));
  t_s_ = 0.0;
  Watch(Look(rest_, T_robot_camera_), rest_, 1.0);
  EXPECT_EQ(watch_.report().state, State::kLearning);
  Watch(Look(rest_, T_robot_camera_), rest_, 7.0);
  EXPECT_EQ(watch_.report().state, State::kHolds);
  Watch({}, rest_, 3.0);
  EXPECT_EQ(watch_.report().state, State::kNotSeen);
  Watch(Look(rest_, T_robot_camera_), rest_, 3.0);
  EXPECT_EQ(watch_.report().state, State::kHolds);
}

}  // namespace
}  // namespace palpate::force_estimation
