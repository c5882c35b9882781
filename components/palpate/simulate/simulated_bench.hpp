// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/core/status.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/bench_inputs.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::command {

/// Inputs of a virtual camera at one time.
struct CameraInput {
  std::size_t camera = 0;  ///< number; 0: the first
  double t_s = 0.0;        ///< since the bench was switched on
  int recording = 0;
  /// The nominal camera pose; hidden effects are added to it.
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// The virtual robot and its camera, as `simulate` uses them. Tests have another implementation.
class SimulatedBench {
 public:
  virtual ~SimulatedBench() = default;

  virtual Status Start(double t_s, const scenario::BenchInputs& inputs) = 0;
  virtual Status Advance(double t_s, const scenario::BenchInputs& inputs) = 0;

  virtual std::vector<virtual_robot::CableReading> Cables() const = 0;  ///< of the robot file
  virtual Eigen::Matrix3Xd Markers_m() const = 0;  ///< [3 x markers of the robot file] robot frame
  /// The same as the depth camera measures them without noise, camera frame; NaN: outside the
  /// image, or on a surface that at rest is beyond the grazing angle.
  virtual Eigen::Matrix3Xd MarkersByCamera_m(const CameraInput& input) const = 0;
  virtual std::vector<virtual_robot::TrueForce> Forces() const = 0;
  virtual std::string MeshHash() const = 0;  ///< of the simulated body

  virtual void TakeFrame(const scenario::BenchInputs& inputs, const CameraInput& input,
                         rgbd::RgbdFrame* frame) = 0;
  virtual Eigen::Isometry3d TrueCameraPose(const CameraInput& input) const = 0;
};

using MakeBench = std::function<std::unique_ptr<SimulatedBench>(
    const robot::RobotDescription&, const scenario::Scenario&,
    const std::vector<scenario::ActiveEffect>&, std::uint64_t seed)>;

/// VirtualRobot and VirtualCamera. Throws InputError where robot, scenario and
/// effects do not fit together.
std::unique_ptr<SimulatedBench> MakeVirtualBench(const robot::RobotDescription& robot,
                                                 const scenario::Scenario& scenario,
                                                 const std::vector<scenario::ActiveEffect>& effects,
                                                 std::uint64_t seed);

}  // namespace palpate::command
