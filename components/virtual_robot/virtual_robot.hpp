// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/tet_mesh.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/bench_inputs.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::virtual_robot {

using ToolPose = scenario::ToolPose;
/// What happens to the robot until the next instant.
using Inputs = scenario::BenchInputs;

/// Readings of the actuators, published as /robot/joint_states.
struct CableReading {
  /// At the actuator, as it reads; of a chamber its change of volume, m3 (NaN: it is not driven).
  double displacement_m = 0.0;
  /// At the actuator; of a chamber the pressure above ambient that its sensor reads, Pa.
  double tension_N = 0.0;
};

/// A force on the robot that an estimator is to find.
struct TrueForce {
  std::string name;  ///< of the tool, of the effect ("permanent_force"), "weight_0"
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();       ///< centre of pressure, robot frame
  Eigen::Vector3d rest_position_m = Eigen::Vector3d::Zero();  ///< the same on the undeformed body
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
};

/// What the time steps so far have cost.
struct StepCost {
  int corrections = 0;     ///< of Newton's method
  int factorisations = 0;  ///< of its tangent
};

/// The robot of the virtual bench: the truth. Not copied or moved.
class VirtualRobot {
 public:
  /// Throws InputError where robot, scenario and effects do not fit together. Effects of the
  /// camera are ignored here. Threads make it faster; with another number of them results are the
  /// same to rounding only.
  VirtualRobot(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
               const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed,
               int threads = 1);
  ~VirtualRobot();
  VirtualRobot(const VirtualRobot&) = delete;
  VirtualRobot& operator=(const VirtualRobot&) = delete;

  /// Hung up under its own weight, commands at zero, at time `t_s`: a new history.
  Status Start(double t_s, const Inputs& inputs);

  /// On to `t_s` with inputs that go linearly from the last ones to these. Not converged: the
  /// state stays where the last good step left it.
  Status Advance(double t_s, const Inputs& inputs);

  double time_s() const;
  const fem::TetMesh& mesh() const;  ///< at rest, as the bench has it
  const fem::BoundarySurface& boundary() const;
  const std::string& mesh_hash() const;
  const Eigen::VectorXd& positions_m() const;       ///< [3n] robot frame
  const std::vector<CableReading>& cables() const;  ///< then those of the chambers
  std::vector<TrueForce> forces() const;
  /// Where the robot's markers are (with marker_misplacement, without noise), robot frame.
  Eigen::Matrix3Xd MarkerPositions_m() const;
  double KineticEnergy_J() const;
  double TotalEnergy_J() const;  ///< elastic, gravity and other dead loads, kinetic
  const StepCost& cost() const;
  /// With what force the body loads its clamp, the weight of the clamped nodes included, robot
  /// frame.
  Eigen::Vector3d SupportForce_N() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::virtual_robot
