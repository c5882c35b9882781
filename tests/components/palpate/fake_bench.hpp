// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "components/palpate/simulate/simulated_bench.hpp"

namespace palpate::command {

/// Inputs that the bench received, and what it is to do.
struct FakeBenchLog {
  struct Step {
    double t_s = 0.0;
    scenario::BenchInputs inputs;
  };
  double started_s = -1.0;
  std::vector<Step> steps;
  std::vector<CameraInput> moments;  ///< of the frames
  std::vector<scenario::ActiveEffect> effects;
  double fails_after_s = 1e9;
  double raises_after_s = 1e9;                                       ///< SIGINT
  Eigen::Isometry3d T_before_after = Eigen::Isometry3d::Identity();  ///< camera, moved by an effect
};

/// Stands in for robot and camera: markers sit still where the robot file has them, but for the
/// first, which the first cable lifts; the actuators report their commands; an image's first
/// pixel counts the frames.
class FakeBench : public SimulatedBench {
 public:
  FakeBench(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
            FakeBenchLog* log)
      : scenario_(scenario), log_(*log) {
    markers_m_.resize(3, static_cast<Eigen::Index>(robot.markers.size()));
    for (std::size_t i = 0; i < robot.markers.size(); ++i) {
      markers_m_.col(static_cast<Eigen::Index>(i)) = robot.markers[i].position_m;
    }
  }

  Status Start(double t_s, const scenario::BenchInputs& inputs) override {
    log_.started_s = t_s;
    inputs_ = inputs;
    return Status::Ok();
  }
  Status Advance(double t_s, const scenario::BenchInputs& inputs) override {
    if (t_s > log_.fails_after_s) return {StatusCode::kInverted, "an element turned inside out"};
    if (t_s > log_.raises_after_s) {
      log_.raises_after_s = 1e9;  // a second signal would end the test
      std::raise(SIGINT);
    }
    log_.steps.push_back({t_s, inputs});
    inputs_ = inputs;
    return Status::Ok();
  }

  std::vector<virtual_robot::CableReading> Cables() const override {
    std::vector<virtual_robot::CableReading> readings;
    for (const double told_m : inputs_.displacement_m) readings.push_back({told_m, 100.0 * told_m});
    return readings;
  }
  Eigen::Matrix3Xd Markers_m() const override {
    Eigen::Matrix3Xd moved_m = markers_m_;
    if (inputs_.displacement_m[0] > 0.0) moved_m(2, 0) += inputs_.displacement_m[0];
    return moved_m;
  }
  Eigen::Matrix3Xd MarkersByCamera_m(const CameraInput& moment) const override {
    Eigen::Matrix3Xd measured_m = TrueCameraPose(moment).inverse() * Markers_m();
    measured_m.row(2) *= 1.5;  // such a camera it is
    return measured_m;
  }
  std::vector<virtual_robot::TrueForce> Forces() const override {
    if (inputs_.tools.empty()) return {};
    return {{inputs_.tools[0].tool, {0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.0, 0.0, -1.5}}};
  }
  std::string MeshHash() const override { return "sha256-of-the-true-mesh"; }

  void TakeFrame(const scenario::BenchInputs&, const CameraInput& moment,
                 rgbd::RgbdFrame* frame) override {
    log_.moments.push_back(moment);
    const rgbd::CameraModel& camera = scenario_.camera->camera.depth;
    frame->depth = rgbd::DepthImage(camera.width_px, camera.height_px, 1000);
    frame->depth.values[0] = static_cast<std::uint16_t>(log_.moments.size());
    if (scenario_.camera->camera.color.width_px > 0) {
      frame->color = rgbd::ColorImage(camera.width_px, camera.height_px, 7);
    }
  }
  Eigen::Isometry3d TrueCameraPose(const CameraInput& moment) const override {
    return moment.T_robot_camera * log_.T_before_after;
  }

 private:
  scenario::Scenario scenario_;
  FakeBenchLog& log_;
  Eigen::Matrix3Xd markers_m_;
  scenario::BenchInputs inputs_;
};

inline MakeBench FakesWith(FakeBenchLog* log) {
  return [log](const robot::RobotDescription& robot, const scenario::Scenario& scenario,
               const std::vector<scenario::ActiveEffect>& effects, std::uint64_t) {
    log->effects = effects;
    return std::make_unique<FakeBench>(robot, scenario, log);
  };
}

}  // namespace palpate::command
