// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
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
/// The same with the converged body itself: the robot file's mesh cut in eight, its element and
/// modulus. Takes some hundred times as long.
scenario::Scenario ConvergedBallScenario();

/// The truth of one instant.
struct SceneState {
  scenario::BenchInputs inputs;
  Eigen::Matrix3Xd nodes_m;  ///< [3 x nodes] of the virtual robot, robot frame
  std::vector<virtual_robot::TrueForce> forces;
  std::vector<virtual_robot::CableReading> cables;
};

/// The virtual robot and the camera in front of it, with all inputs of an estimator and the
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

  /// From now on the camera is rotated about itself, and the estimator does not know.
  void TurnCamera(const Eigen::Quaterniond& turn) { unknown_turn_ = turn; }

  /// The next of the frames that the camera takes of what is there, 1/rate_hz later each, with
  /// noise. Holds until the next call.
  const rgbd::RgbdFrame& TakeFrame();
  const rgbd::RgbdFrame& frame() const { return frame_; }
  /// z of what is really there in each pixel of the last frame, m; NaN: nothing.
  const rgbd::RangeImage& true_range() const { return camera_.true_range(); }

  const rgbd::RgbdCamera& camera() const { return scenario_.camera->camera; }
  const Eigen::Isometry3d& T_robot_camera() const { return scenario_.camera->T_robot_camera; }
  const scenario::Scenario& scenario() const { return scenario_; }
  const virtual_robot::VirtualRobot& robot() const { return robot_; }
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }  ///< [3 x t] of the true surface
  Eigen::Matrix3Xd NodesInCamera_m() const;                         ///< [3 x nodes] camera frame
  /// The cable inputs of the estimator: displacements.
  std::vector<robot::ActuatorCommand> Cables() const;

 private:
  void Read(const scenario::BenchInputs& inputs);

  scenario::Scenario scenario_;
  std::vector<scenario::ActiveEffect> effects_;
  virtual_robot::VirtualRobot robot_;
  Eigen::Matrix3Xi triangles_;
  virtual_camera::VirtualCamera camera_;
  double t_s_ = 0.0;
  SceneState state_;
  Eigen::Quaterniond unknown_turn_ = Eigen::Quaterniond::Identity();
  std::int64_t frames_ = 0;
  rgbd::RgbdFrame frame_;
};

}  // namespace palpate::test_support
