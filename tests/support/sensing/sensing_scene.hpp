// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/virtual_camera/virtual_camera.hpp"
#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/scenario/bench_inputs.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::test_support {

/// Bench and camera of config/scenarios/pushes.yaml with the body of config/scenarios/sensing.yaml,
/// which moves as the converged one does; balls of 8, 10 and 12 mm radius and friction 0.3 (ball_8,
/// ball_10, ball_12), each of its own colour, and a hand (hand).
scenario::Scenario BallScenario();
/// The same of config/scenarios/pneumatic_finger.yaml, with balls of 5, 6 and 7 mm. The body is the
/// robot file's.
scenario::Scenario FingerBallScenario();
/// A second camera, opposite the first: that of config/scenarios/two_cameras.yaml.
std::vector<scenario::FurtherCamera> OppositeCamera();
/// BallScenario with the converged body itself: the robot file's mesh cut in eight, its element and
/// modulus. Takes some hundred times as long.
scenario::Scenario ConvergedBallScenario();

/// The truth of one instant.
struct SceneState {
  scenario::BenchInputs inputs;
  Eigen::Matrix3Xd nodes_m;  ///< [3 x nodes] of the virtual robot, robot frame
  std::vector<virtual_robot::TrueForce> forces;
  std::vector<virtual_robot::CableReading> cables;
};

/// The virtual robot and the cameras in front of it, with all inputs of an estimator and the
/// truth that it is to estimate. The same arguments and calls give the same bits.
class SensingScene {
 public:
  /// `scenario` needs a camera; its effects and clutter are drawn from the seed. The robot hangs
  /// under its own weight, cables at zero, nothing touches it. Throws InputError, RunError.
  SensingScene(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
               std::uint64_t seed);

  /// A new history from these inputs on.
  Status Start(const scenario::BenchInputs& inputs);
  /// Straight on from where tools, cables and weights are, in one time step of the scenario. Not
  /// ok: state() is as before.
  Status Go(const scenario::BenchInputs& inputs);
  /// Cables at zero, nothing there.
  scenario::BenchInputs Nothing() const;

  const SceneState& state() const { return state_; }
  /// The camera sees that state from now on, until the next Start or Go, which go on from where the
  /// robot is: for states that were kept.
  void Show(const SceneState& state) { state_ = state; }

  /// From now on the first camera is rotated about itself, and the estimator does not know.
  void TurnCamera(const Eigen::Quaterniond& turn) { unknown_turn_ = turn; }

  /// The next of the frames that the first `cameras` cameras take of what is there, 1/rate_hz later
  /// each, with noise. Returns that of the first. Holds until the next call.
  const rgbd::RgbdFrame& TakeFrame(std::size_t cameras = 1);
  const rgbd::RgbdFrame& frame(std::size_t camera = 0) const { return frames_[camera]; }
  /// z of what is really there in each pixel of the last frame, m; NaN: nothing.
  const rgbd::RangeImage& true_range(std::size_t camera = 0) const {
    return cameras_[camera]->true_range();
  }

  std::size_t CameraCount() const { return cameras_.size(); }
  const scenario::CameraSpec& spec(std::size_t camera = 0) const {
    return camera == 0 ? *scenario_.camera : scenario_.further_cameras[camera - 1];
  }
  const rgbd::RgbdCamera& camera(std::size_t number = 0) const { return spec(number).camera; }
  const Eigen::Isometry3d& T_robot_camera(std::size_t camera = 0) const {
    return spec(camera).T_robot_camera;
  }
  const scenario::Scenario& scenario() const { return scenario_; }
  const virtual_robot::VirtualRobot& robot() const { return robot_; }
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }  ///< [3 x t] of the true surface
  Eigen::Matrix3Xd NodesInCamera_m(std::size_t camera = 0) const;   ///< [3 x nodes] camera frame
  /// The inputs of the estimator: displacements of cables, pressures of chambers.
  std::vector<robot::ActuatorCommand> Cables() const;

 private:
  void Read(const scenario::BenchInputs& inputs);

  scenario::Scenario scenario_;
  std::vector<scenario::ActiveEffect> effects_;
  std::vector<robot::ActuatorTraits> actuators_;
  virtual_robot::VirtualRobot robot_;
  Eigen::Matrix3Xi triangles_;
  std::vector<std::unique_ptr<virtual_camera::VirtualCamera>> cameras_;
  double t_s_ = 0.0;
  SceneState state_;
  Eigen::Quaterniond unknown_turn_ = Eigen::Quaterniond::Identity();
  std::int64_t taken_ = 0;
  std::vector<rgbd::RgbdFrame> frames_;  ///< of each camera
};

}  // namespace palpate::test_support
