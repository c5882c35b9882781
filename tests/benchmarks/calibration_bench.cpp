// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/calibration_bench.hpp"

#include <Eigen/Geometry>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/calibration/joint/joint_request.hpp"
#include "libs/core/error.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/benchmarks/robots.hpp"
#include "tests/support/robots.hpp"

namespace palpate::benchmarks {

namespace {

using calibration::CalibrationFrame;
using Kind = robot::ActuatorCommand::Kind;

constexpr double kNoise_m = 3e-4;
constexpr int kManyFrames = 10;
constexpr double kLoad_N = 0.5;
constexpr double kActuatorOffset_m = 7e-4;

/// RobotBody::materials of the many frames, and what their moduli are times the robot file's.
const std::vector<std::pair<int, double>> kModuli = {{0, 1.08}, {1, 0.9}, {2, 1.15}};

geometry::RigidTransform CameraPose() {
  const Eigen::AngleAxisd turn(2.0, Eigen::Vector3d(1.0, -0.6, 0.3).normalized());
  return {Eigen::Quaterniond(turn), Eigen::Vector3d(-0.27, 0.26, 0.3)};
}

/// A robot as its file says, and what a camera saw of the true one.
class CalibrationScene {
 public:
  CalibrationScene(const robot::RobotDescription& robot, int frames)
      : model_(robot::BuildRobotBody(robot)), truth_(robot::BuildRobotBody(robot)) {
    if (frames == 1) {
      See("table_1",
          {{Kind::kTension, 1.2},
           {Kind::kTension, 1.0},
           {Kind::kTension, 1.0},
           {Kind::kTension, 1.2}},
          {});
      frames_[0].cables.assign(4, {});  // nothing is known of them
      return;
    }
    for (const auto& [material, factor] : kModuli) {
      request_.moduli.push_back(material);
      truth_.SetYoungsModulus(
          material,
          factor * truth_.body().materials[static_cast<size_t>(material)].youngs_modulus_Pa);
    }
    for (int f = 0; f < frames; ++f) SeePulled(f);
  }

  calibration::JointCalibration Calibrate() {
    // As the robot file says, whatever the last one left.
    for (const auto& [material, factor] : kModuli) {
      if (request_.moduli.empty()) break;
      const auto& true_one = truth_.body().materials[static_cast<size_t>(material)];
      model_.SetYoungsModulus(material, true_one.youngs_modulus_Pa / factor);
    }
    return calibration::CalibrateFrames(model_, frames_, nullptr, request_);
  }

 private:
  void SeePulled(int frame) {
    std::vector<robot::ActuatorCommand> cables;
    for (int c = 0; c < truth_.CableCount(); ++c) {
      cables.push_back({Kind::kDisplacement, 1e-3 * (3.0 + (3 * frame + 2 * c) % 7)});
    }
    std::vector<robot::DeadLoad> loads;
    if (frame % 2 == 0) {
      const Eigen::Vector3d force_N = kLoad_N * Eigen::Vector3d::Unit(frame % 3);
      loads.push_back({truth_.Patch({0.0, 0.0, 0.125}, 0.005).weights, force_N});
    }
    See("frame " + std::to_string(frame), cables, loads);
    for (robot::ActuatorCommand& cable : frames_.back().cables) cable.value -= kActuatorOffset_m;
  }

  void See(const std::string& name, const std::vector<robot::ActuatorCommand>& cables,
           const std::vector<robot::DeadLoad>& loads) {
    fem::StaticState state = truth_.RestState();
    const fem::StaticResult result = truth_.Solve(cables, loads, &state);
    if (!result.status.ok()) throw RunError(name + ": " + result.status.message());
    CalibrationFrame frame{
        .name = name, .cables = cables, .loads = loads, .gravity_m_s2 = truth_.gravity_m_s2()};
    std::normal_distribution<double> noise(0.0, kNoise_m);
    const geometry::RigidTransform T_camera_robot = CameraPose().Inverse();
    for (const robot::BodyMarker& marker : truth_.body().markers) {
      calibration::MarkerSighting sighting{
          .marker = static_cast<int>(frame.markers.size()),
          .position_m = T_camera_robot * marker.point.weights.Position(state.x_m),
          .covariance_m2 = kNoise_m * kNoise_m * Eigen::Matrix3d::Identity()};
      for (double& coordinate : sighting.position_m) coordinate += noise(random_);
      frame.markers.push_back(sighting);
    }
    frames_.push_back(std::move(frame));
  }

  robot::RobotModel model_;
  robot::RobotModel truth_;
  std::mt19937_64 random_{1};
  std::vector<CalibrationFrame> frames_;
  calibration::JointRequest request_;
};

Benchmark MakeBenchmark(const std::string& name, const robot::RobotDescription& robot, int frames) {
  const auto scene = MakeLazy<CalibrationScene>(
      [robot, frames] { return std::make_unique<CalibrationScene>(robot, frames); });
  return {.name = "calibration/" + name,
          .measure =
              [scene](benchmark::State& state) {
                CalibrationScene& of = scene->Get();
                for ([[maybe_unused]] auto iteration : state) {
                  const calibration::JointCalibration found = of.Calibrate();
                  if (!found.status.ok()) state.SkipWithError(found.status.message().c_str());
                  state.counters["iterations"] = found.iterations;
                }
              },
          .max_repetitions = 9};
}

}  // namespace

Block CalibrationBlock() {
  const robot::RobotDescription tet10 = OwnRobot("four_leg", fem::ElementType::kTet10).description;
  const robot::RobotDescription tet4 = OwnRobot("four_leg", fem::ElementType::kTet4).description;
  Block block{
      .heading = "joint calibration, nine markers",
      .benchmarks = {MakeBenchmark("four_leg_tet10/one_frame", tet10, 1),
                     MakeBenchmark("four_leg_tet10/ten_frames_three_moduli", tet10, kManyFrames),
                     MakeBenchmark("four_leg_tet4/one_frame", tet4, 1)}};
  if (const auto diamond = test_support::DiamondWithMarkers()) {
    block.benchmarks.push_back(MakeBenchmark("diamond_tet4/one_frame", *diamond, 1));
  }
  return block;
}

}  // namespace palpate::benchmarks
