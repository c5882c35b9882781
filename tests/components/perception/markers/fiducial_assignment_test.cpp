// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// From the image to the pose without manual input: discs of one colour on the actuated robot are
// detected and assigned by their positions, and the camera pose follows.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "components/calibration/pose/marker_assignment.hpp"
#include "tests/components/calibration/table_one.hpp"
#include "tests/components/perception/markers/marked_scene.hpp"
#include "tests/support/robots.hpp"

namespace palpate::perception {
namespace {

using calibration::MarkerAssignment;

/// Thirteen that face upwards, no turn of which looks like another.
robot::RobotDescription ManyMarkers() {
  robot::RobotDescription robot = test_support::QuickFourLegRobot();
  robot.markers.clear();
  for (const Eigen::Vector3d& position_m :
       {Eigen::Vector3d(0.003, 0.002, 0.125), Eigen::Vector3d(0.003, 0.0470, 0.0980),
        Eigen::Vector3d(-0.003, 0.0640, 0.0800), Eigen::Vector3d(0.002, 0.0840, 0.0530),
        Eigen::Vector3d(-0.0510, 0.003, 0.0930), Eigen::Vector3d(-0.0700, 0.0, 0.0710),
        Eigen::Vector3d(-0.0890, -0.003, 0.0450), Eigen::Vector3d(0.0, -0.0490, 0.0950),
        Eigen::Vector3d(0.003, -0.0740, 0.0670), Eigen::Vector3d(-0.003, -0.0920, 0.0400),
        Eigen::Vector3d(0.0450, 0.0, 0.1000), Eigen::Vector3d(0.0600, 0.003, 0.0850),
        Eigen::Vector3d(0.0790, -0.003, 0.0600)}) {
    robot::MarkerSettings& marker = robot.markers.emplace_back();
    marker.name = "m";
    marker.name += std::to_string(robot.markers.size());
    marker.position_m = position_m;
  }
  return OnSkin(robot);
}

struct Bench {
  robot::RobotDescription robot = ManyMarkers();
  std::unique_ptr<robot::RobotModel> model = calibration::Build(robot);
  virtual_camera::RobotSurface skin = SkinOf(robot);
  calibration::SolvedShapes solved =
      calibration::SolveMarkerShapes(*model, Eigen::Vector4d::Constant(3.5));
};

/// What one picture gave.
struct Outcome {
  std::vector<int> truth;     ///< [fiducials] marker
  MarkerAssignment assigned;  ///< of them
  calibration::PoseAndInputs pose;
  double pose_error_m =
      0.0;  ///< RMS over the markers: where the pose takes them and where it should
};

double PoseError_m(const geometry::RigidTransform& found, const Eigen::Isometry3d& T_robot_camera,
                   const std::vector<TrueMarker>& markers) {
  double squares = 0.0;
  for (const TrueMarker& marker : markers) {
    squares += (found * marker.position_m - T_robot_camera * marker.position_m).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(markers.size()));
}

Outcome LookAt(const scenario::Scenario& scenario, const FiducialConfig& config,
               const Eigen::Vector4d& tension_N, std::uint64_t seed, const Bench& bench) {
  MarkedScene scene(bench.skin, scenario, seed);
  virtual_camera::View view = scene.Rest();
  const fem::StaticState state = calibration::SolveTensions(*bench.model, tension_N);
  view.nodes_m = state.x_m.reshaped(3, state.x_m.size() / 3);
  FiducialDetector detector(config);
  detector.SetCamera(scenario.camera->camera);
  const FiducialFrame& found = detector.Detect(scene.Take(view));
  Outcome outcome;
  Eigen::Matrix3Xd points_m(3, static_cast<Eigen::Index>(found.fiducials.size()));
  for (std::size_t i = 0; i < found.fiducials.size(); ++i) {
    points_m.col(static_cast<Eigen::Index>(i)) = found.fiducials[i].position_m;
    outcome.truth.push_back(NearestMarker(scene.truth(), found.fiducials[i]));
  }
  outcome.assigned = calibration::AssignMarkers(bench.solved.shapes, points_m, {.sigma_m = 1e-3});
  if (!outcome.assigned.status.ok()) return outcome;
  std::vector<calibration::MarkerSighting> sightings;
  for (std::size_t i = 0; i < outcome.truth.size(); ++i) {
    const int marker = outcome.assigned.marker_of_point[i];
    if (marker < 0) continue;
    const Fiducial& fiducial = found.fiducials[i];
    sightings.push_back({marker, fiducial.position_m, fiducial.covariance_m2});
  }
  outcome.pose = calibration::RunAlgorithm1(*bench.model, sightings, {.tolerance_N = 0.2});
  outcome.pose_error_m =
      PoseError_m(outcome.pose.T_robot_camera, view.T_robot_camera, scene.truth());
  return outcome;
}

/// Six pictures, two views of three bends each: labels right, and the worst error of the pose.
double WorstPose_m(scenario::Scenario scenario, const FiducialConfig& config) {
  const Bench bench;
  EXPECT_TRUE(bench.solved.status.ok()) << bench.solved.status.message();
  double worst_m = 0.0;
  std::uint64_t seed = 0;
  for (const double height_deg : {70.0, 85.0}) {
    PlaceCamera(0.45, -45.0, height_deg, &scenario);
    for (const Eigen::Vector4d& tension_N :
         {Eigen::Vector4d(2.0, 1.0, 0.5, 1.5), Eigen::Vector4d(0.3, 2.5, 1.8, 0.8),
          Eigen::Vector4d(1.2, 1.0, 1.0, 1.2)}) {
      const Outcome outcome = LookAt(scenario, config, tension_N, ++seed, bench);
      EXPECT_TRUE(outcome.assigned.status.ok()) << outcome.assigned.status.message();
      EXPECT_EQ(outcome.assigned.marker_of_point, outcome.truth);
      EXPECT_GE(outcome.truth.size(), 8u);
      EXPECT_TRUE(outcome.pose.status.ok()) << outcome.pose.status.message();
      std::printf("%zu markers, pose off by %.2f mm\n", outcome.truth.size(),
                  1e3 * outcome.pose_error_m);
      worst_m = std::max(worst_m, outcome.pose_error_m);
    }
  }
  return worst_m;
}

TEST(FiducialAssignment, FromThePictureToLabelsAndPose) {
  scenario::Scenario scenario = MarkedScenario();
  scenario.camera->noise.low_frequency_bias = 0.0;
  FiducialConfig config = ConfigOf(scenario);
  config.depth_bias = 0.0;
  EXPECT_LT(WorstPose_m(scenario, config), 1.5e-3);
}

/// A depth image that is bent by 0.3 % of z, 1.35 mm here, in an unknown shape.
TEST(FiducialAssignment, LabelsStandABentDepthImage) {
  const scenario::Scenario scenario = MarkedScenario();
  EXPECT_LT(WorstPose_m(scenario, ConfigOf(scenario)), 3.0 * 1.35e-3);
}

}  // namespace
}  // namespace palpate::perception
