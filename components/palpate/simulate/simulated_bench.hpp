// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
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

/// What the virtual camera has to know of the moment.
struct CameraMoment {
  double t_s = 0.0;  ///< since the bench was switched on
  int recording = 0;
  /// Where everybody takes the depth camera to be; effects come on top.
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// The virtual robot and the camera in front of it, as `simulate` uses them. Tests put another one
/// here.
class SimulatedBench {
 public:
  virtual ~SimulatedBench() = default;

  virtual Status Start(double t_s, const scenario::BenchInputs& inputs) = 0;
  virtual Status Advance(double t_s, const scenario::BenchInputs& inputs) = 0;

  virtual std::vector<virtual_robot::CableReading> Cables() const = 0;  ///< of the robot file
  virtual Eigen::Matrix3Xd Markers_m() const = 0;  ///< [3 x markers of the robot file] robot frame
  /// The same as the depth camera measures them without noise, its frame; NaN: out of its picture,
  /// or on skin that at rest is beyond its grazing angle.
  virtual Eigen::Matrix3Xd MarkersByCamera_m(const CameraMoment& moment) const = 0;
  virtual std::vector<virtual_robot::TrueForce> Forces() const = 0;
  virtual std::string MeshHash() const = 0;  ///< of the body as it really is

  virtual void TakeFrame(const scenario::BenchInputs& inputs, const CameraMoment& moment,
                         rgbd::RgbdFrame* frame) = 0;
  virtual Eigen::Isometry3d TrueCameraPose(const CameraMoment& moment) const = 0;
};

using MakeBench = std::function<std::unique_ptr<SimulatedBench>(
    const robot::RobotDescription&, const scenario::Scenario&,
    const std::vector<scenario::ActiveEffect>&, std::uint64_t seed)>;

/// The real ones: VirtualRobot and VirtualCamera. Throws InputError where robot, scenario and
/// effects do not fit together.
std::unique_ptr<SimulatedBench> MakeVirtualBench(const robot::RobotDescription& robot,
                                                 const scenario::Scenario& scenario,
                                                 const std::vector<scenario::ActiveEffect>& effects,
                                                 std::uint64_t seed);

}  // namespace palpate::command
