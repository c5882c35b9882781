// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "libs/fem/element_derivative.hpp"
#include "libs/robot/cable_path.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

namespace palpate::robot {

/// The equilibrium about which sensitivities are taken, as parameters see it. What is costly is
/// worked out when a parameter first asks for it. For one thread.
class EquilibriumPoint {
 public:
  /// `model` must outlive it.
  explicit EquilibriumPoint(RobotModel& model);

  /// Moves to another equilibrium. `model`'s linearisation is at this state.
  void Set(const std::vector<ActuatorCommand>& commands, const fem::StaticState& state);

  RobotModel& model() const { return model_; }
  const std::vector<fem::Material>& materials() const { return model_.elastic_body().materials(); }
  const Eigen::VectorXd& x_m() const { return x_m_; }  ///< [3n]
  double tension_N(int actuator) const { return tension_N_[actuator]; }
  /// It pulls, and holds its length: displacement is commanded, and the tension is between its
  /// limits. (At the limit the actuator yields: the tension stays.)
  bool KeepsLength(int actuator) const;
  const ActuatorCommand& command(int actuator) const { return commands_[Index(actuator)]; }
  const CablePath& path(int cable) const { return paths_.at(Index(cable)); }
  const CablePath& rest_path(int cable) const { return rest_paths_.at(Index(cable)); }
  /// How the value of an actuator at rest changes along a mode [3n] of the rest shape.
  double RestLengthAlong(int actuator, const Eigen::VectorXd& mode_m) const;
  bool Holds(Eigen::Index node, Eigen::Index direction) const;
  /// [3n] in held directions the force that the body exerts on its base.
  const Eigen::VectorXd& force_on_base_N() const;

  const fem::ElementDerivative& elements() const;
  /// [n] m^3 each node's share of the undeformed body's volume, and how it changes along a mode
  /// [3n] of the rest shape; of the last mode only it is kept.
  const Eigen::VectorXd& nodal_volume_m3() const;
  const Eigen::VectorXd& NodalVolumeAlong(const Eigen::VectorXd& mode_m) const;
  /// F_int = sum over materials of lambda L + mu M (fem/element_derivative.hpp): L and M [3n x
  /// materials].
  const Eigen::MatrixXd& forces_per_lambda_m2() const;
  const Eigen::MatrixXd& forces_per_mu_m2() const;

  /// Adds what moving the points of a cable's path (pull point first) by `motion_m` [3 x points]
  /// per unit of p does, the points keeping their hold on the body.
  void MovePath(int cable, const Eigen::Matrix3Xd& motion_m, ParameterColumn* column) const;
  /// Adds `tension_N` times forces on the points of a cable's path [3 x points] per 1 N at the
  /// drive.
  void PullPath(int cable, double tension_N, const Eigen::Matrix3Xd& force,
                ParameterColumn* column) const;
  /// Adds a motion of one node, in its held directions only.
  void MoveHeldNode(Eigen::Index node, const Eigen::Vector3d& motion_m,
                    ParameterColumn* column) const;
  /// The motion of the path's points [3 x points] that goes with a nodal motion [3n]; the pull
  /// point stays.
  void PathMotion(int cable, const Eigen::VectorXd& nodal_m, Eigen::Matrix3Xd* motion_m) const;
  /// Adds what the motion of the held nodes does to the free ones, and what commanded tensions
  /// pull. After the parameter's own part.
  void Complete(ParameterColumn* column) const;

 private:
  size_t Index(int actuator) const;
  /// What a nodal motion [3n] of its wall does to a chamber.
  void MoveChamberWall(int actuator, const Eigen::VectorXd& motion_m,
                       ParameterColumn* column) const;
  void EvaluateRestPaths();
  void EvaluateLameForces() const;
  void ApplyHeldMotion(ParameterColumn* column) const;

  RobotModel& model_;
  std::vector<ActuatorCommand> commands_;
  Eigen::VectorXd x_m_;
  Eigen::VectorXd tension_N_;
  std::vector<CablePath> paths_;
  std::vector<CablePath> rest_paths_;
  mutable std::unique_ptr<fem::ElementDerivative> elements_;
  mutable Eigen::VectorXd nodal_volume_m3_;
  mutable Eigen::VectorXd mode_m_, volume_along_mode_;
  mutable bool has_lame_forces_ = false;
  mutable Eigen::MatrixXd per_lambda_m2_;
  mutable Eigen::MatrixXd per_mu_m2_;
  mutable std::vector<Eigen::Matrix3Xd> path_m_;  ///< [cables] points, or their motion
  mutable std::vector<Eigen::Matrix3Xd> force_;   ///< [cables] on these points
};

}  // namespace palpate::robot
