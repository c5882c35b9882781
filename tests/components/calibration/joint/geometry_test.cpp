// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "libs/robot/calibrated_geometry.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"

namespace palpate::calibration {
namespace {

constexpr double kNoise_m = 1e-5;

/// Size, guides and depth of a robot that differs from its file.
class GeometryOfOurRobot : public testing::Test {
 protected:
  std::vector<CalibrationFrame> See(robot::RobotModel& truth, double scale = 1.0) {
    std::vector<CalibrationFrame> frames;
    for (int f = 0; f < 5; ++f) {
      std::vector<double> pulls_m;
      for (int c = 0; c < 4; ++c) pulls_m.push_back(1e-3 * (4.0 + (5 * f + 3 * c) % 8));
      FrameInputs inputs{.cables = Commands(Kind::kDisplacement, pulls_m), .scale = scale};
      const FrameInputs acting = ToModel(inputs);
      truth.SetGravity(acting.mass_factor * model_->gravity_m_s2());
      CalibrationFrame frame =
          calibration::See(truth, geometry::RigidTransform(), "pull " + std::to_string(f),
                           acting.cables, {}, kNoise_m);
      std::normal_distribution<double> noise(0.0, kNoise_m);
      for (MarkerSighting& sighting : frame.markers) {
        sighting.position_m = TableOnePose().Inverse() * (scale * sighting.position_m);
        for (double& coordinate : sighting.position_m) coordinate += noise(random_);
      }
      frame.cables = inputs.cables;
      frame.gravity_m_s2 = model_->gravity_m_s2();
      frames.push_back(std::move(frame));
    }
    return frames;
  }

  static void ExpectFound(const JointCalibration& fit, const std::string& name, double truth,
                          double most_error) {
    const FittedValue* found = ValueNamed(fit, name);
    ASSERT_NE(found, nullptr);
    EXPECT_TRUE(found->determined) << name;
    EXPECT_NEAR(found->value, truth, 4.0 * found->standard_error) << name;
    EXPECT_LT(found->standard_error, most_error) << name;
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  std::unique_ptr<robot::RobotModel> truth_ = Build(QuickFourLegRobot());
  std::mt19937_64 random_{7};
};

TEST_F(GeometryOfOurRobot, ItsSizeShowsInMarkers) {
  const JointCalibration fit = CalibrateFrames(
      *model_, See(*truth_, 1.02), nullptr,
      {.actuator_offsets = false, .geometry_scale_sigma = 0.01, .marker_placement_sigma_m = 0.0});
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectFound(fit, "geometry_scale", 1.02, 1e-3);
  ExpectPose(fit.T_robot_camera, TableOnePose(), 1e-3, 5e-4);
  robot::CalibrationFile file = robot::DescribeForCalibration(*model_);
  TakeFit(fit, *model_, &file);
  ASSERT_TRUE(file.geometry_scale);
  EXPECT_EQ(file.geometry_scale->scale, ValueNamed(fit, "geometry_scale")->value);
  EXPECT_EQ(file.geometry_scale->standard_error, ValueNamed(fit, "geometry_scale")->standard_error);
  EXPECT_TRUE(file.cable_routes.empty()) << "they were not to be estimated";
  EXPECT_LT(fit.residual_rms_m, 3.0 * kNoise_m);
}

/// The robot is 4 % larger: what lies 6 cm from its middle is 2.4 mm farther in on the model.
TEST_F(GeometryOfOurRobot, LoadsStayWhereTheyAreAsItsSizeChanges) {
  constexpr double kScale = 1.04;
  const LoadPlace place{{0.06, 0.0, 0.085}, 0.006};
  robot::RobotBody body = robot::BuildRobotBody(QuickFourLegRobot());
  robot::ScaleBody(kScale, &body);
  robot::RobotModel larger(std::move(body));
  std::vector<CalibrationFrame> frames;
  for (int f = 0; f < 3; ++f) {
    std::vector<double> pulls_m;
    for (int c = 0; c < 4; ++c) pulls_m.push_back(1e-3 * (4.0 + (5 * f + 3 * c) % 8));
    const Eigen::Vector3d force_N(0.3 * f, -1.0, -2.0);
    CalibrationFrame frame = calibration::See(
        larger, TableOnePose(), "push " + std::to_string(f), Commands(Kind::kDisplacement, pulls_m),
        {{larger.Patch(place.position_m, place.patch_radius_m).weights, force_N}}, kNoise_m,
        &random_);
    frame.loads.front().weights = model_->Patch(place.position_m, place.patch_radius_m).weights;
    frame.load_places = {place};
    frames.push_back(std::move(frame));
  }
  const JointCalibration fit = CalibrateFrames(
      *model_, frames, nullptr,
      {.actuator_offsets = false, .geometry_scale_sigma = 0.02, .marker_placement_sigma_m = 0.0});
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectFound(fit, "geometry_scale", kScale, 1e-3);
  EXPECT_LT(fit.residual_rms_m, 3.0 * kNoise_m);
}

/// A robot that is larger and a depth that is too short look alike but for what the cables say.
TEST_F(GeometryOfOurRobot, SizeAndDepthAreToldByTheCablesAloneAndNamedWhereTheyAreNot) {
  std::vector<CalibrationFrame> frames = See(*truth_, 1.02);
  JointRequest request{.actuator_offsets = false,
                       .geometry_scale_sigma = 0.01,
                       .depth_scale_sigma = 0.01,
                       .marker_placement_sigma_m = 0.0};
  const JointCalibration fit = CalibrateFrames(*model_, frames, nullptr, request);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectFound(fit, "geometry_scale", 1.02, 5e-3);
  ExpectFound(fit, "depth_scale", 0.0, 5e-3);
  const std::vector<CorrelatedValues> correlated = FindCorrelated(fit, 0.9);
  ASSERT_EQ(correlated.size(), 1u);
  EXPECT_EQ(std::set<std::string>({correlated[0].one, correlated[0].other}),
            std::set<std::string>({"geometry_scale", "depth_scale"}));
  EXPECT_LE(std::abs(correlated[0].correlation), 1.0);
  EXPECT_TRUE(FindCorrelated(fit, 1.0).empty());
  for (CalibrationFrame& frame : frames) {
    for (MarkerSighting& sighting : frame.markers) sighting.covariance_m2 *= 1e4;
  }
  const JointCalibration vague = CalibrateFrames(*model_, frames, nullptr, request);
  ASSERT_TRUE(vague.status.ok()) << vague.status.message();
  const FittedValue* scale = ValueNamed(vague, "geometry_scale");
  const FittedValue* depth = ValueNamed(vague, "depth_scale");
  EXPECT_FALSE(scale->determined && depth->determined);
  EXPECT_TRUE(scale->determined || depth->determined);
  const FittedValue* held = scale->determined ? depth : scale;
  EXPECT_EQ(held->value, held == scale ? 1.0 : 0.0);
  EXPECT_NEAR(held->standard_error, 0.01, 1e-12);
  EXPECT_FALSE(held->what_would_tell.empty());
}

TEST_F(GeometryOfOurRobot, GuidesOfItsCablesShow) {
  const Eigen::Vector3d guide_m = model_->cable(1).pull_point_m();
  const auto across = AcrossCable(model_->body(), 1, 0);
  truth_->SetPullPoint(1, guide_m + 1.5e-3 * across[0].direction - 1e-3 * across[1].direction);
  const JointCalibration fit = CalibrateFrames(
      *model_, See(*truth_), nullptr,
      {.actuator_offsets = false, .cable_route_sigma_m = 2e-3, .marker_placement_sigma_m = 0.0});
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const std::string name = "cable_route:" + model_->ActuatorNames()[1] + ":";
  ExpectFound(fit, name + across[0].name, 1.5e-3, 5e-4);
  ExpectFound(fit, name + across[1].name, -1e-3, 5e-4);
  robot::CalibrationFile file = robot::DescribeForCalibration(*model_);
  TakeFit(fit, *model_, &file);
  const auto route = std::find_if(
      file.cable_routes.begin(), file.cable_routes.end(),
      [&](const robot::CalibratedRoute& one) { return one.cable == model_->ActuatorNames()[1]; });
  ASSERT_NE(route, file.cable_routes.end());
  const auto calibrated = Build(QuickFourLegRobot());
  robot::ApplyCalibration(file, calibrated.get());
  EXPECT_LT((calibrated->cable(1).pull_point_m() - truth_->cable(1).pull_point_m()).norm(),
            4.0 * route->standard_error_m.norm());
  EXPECT_FALSE(file.geometry_scale);
  EXPECT_LT(fit.residual_rms_m, 3.0 * kNoise_m);
}

TEST_F(GeometryOfOurRobot, EyeletsOfItsCablesShow) {
  constexpr int kCable = 1;
  const auto across = AcrossCable(model_->body(), kCable, 1);
  robot::CalibrationFile moved = robot::DescribeForCalibration(*model_);
  moved.cable_routes = {{.cable = model_->ActuatorNames()[kCable],
                         .point = 1,
                         .moved_m = 1.5e-3 * across[0].direction - 1e-3 * across[1].direction}};
  robot::RobotBody body = robot::BuildRobotBody(QuickFourLegRobot());
  robot::ApplyGeometry(moved, &body);
  robot::RobotModel truth(std::move(body));
  const auto with_room = BuildWithRoom(QuickFourLegRobot(), 4e-3);
  const JointCalibration fit = CalibrateFrames(
      *with_room, See(truth), nullptr,
      {.actuator_offsets = false, .cable_eyelet_sigma_m = 1e-3, .marker_placement_sigma_m = 0.0});
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  ExpectFound(fit, RouteName(moved.cable_routes[0].cable, 1, across[0].name), 1.5e-3, 3e-4);
  ExpectFound(fit, RouteName(moved.cable_routes[0].cable, 1, across[1].name), -1e-3, 3e-4);
  EXPECT_LT(fit.residual_rms_m, 3.0 * kNoise_m);
  robot::CalibrationFile file = robot::DescribeForCalibration(*with_room);
  TakeFit(fit, *with_room, &file);
  robot::RobotBody calibrated = robot::BuildRobotBody(QuickFourLegRobot());
  robot::ApplyGeometry(file, &calibrated);
  const auto eyelet_m = [](const robot::RobotBody& of) {
    return of.cables[kCable].eyelets[0].rest_m;
  };
  EXPECT_LT((eyelet_m(calibrated) - eyelet_m(truth.body())).norm(), 5e-4);
  EXPECT_TRUE(robot::CheckCalibration(file, robot::RobotModel(calibrated)).ok());
  EXPECT_FALSE(robot::CheckCalibration(file, *model_).ok()) << "its eyelets are not there";
}

TEST_F(GeometryOfOurRobot, EyeletsNeedAModelWithRoom) {
  const JointCalibration fit =
      CalibrateFrames(*model_, See(*truth_), nullptr, {.cable_eyelet_sigma_m = 1e-3});
  EXPECT_EQ(fit.status.code(), StatusCode::kInvalidInput);
  EXPECT_NE(fit.status.message().find("room to move eyelets by 0.001 m"), std::string::npos)
      << fit.status.message();
}

TEST_F(GeometryOfOurRobot, PathsArePutBackWhereNothingIsFound) {
  const auto model = BuildWithRoom(QuickFourLegRobot(), 4e-3);
  const Eigen::Vector3d guide_m = model->cable(0).pull_point_m();
  const Eigen::VectorXd rest_length_m = model->actuator_rest_m();
  const std::vector<double> weights = model->cable(1).eyelets()[0].weights;
  const ModelSnapshot kept(*model);
  model->SetPullPoint(0, guide_m + Eigen::Vector3d(0.0, 0.0, -0.01));
  ASSERT_TRUE(model->MoveEyelet(1, 0, Eigen::Vector3d(2e-3, 0.0, 1e-3)).ok());
  EXPECT_NE(model->actuator_rest_m()[0], rest_length_m[0]);
  EXPECT_NE(model->actuator_rest_m()[1], rest_length_m[1]);
  kept.Restore();
  EXPECT_EQ(model->cable(0).pull_point_m(), guide_m);
  EXPECT_LT((model->actuator_rest_m() - rest_length_m).lpNorm<Eigen::Infinity>(), 1e-15);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    EXPECT_NEAR(model->cable(1).eyelets()[0].weights[k], weights[k], 1e-12);
  }
}

}  // namespace
}  // namespace palpate::calibration
