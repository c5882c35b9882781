// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/equilibrium_point.hpp"

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::robot {

EquilibriumPoint::EquilibriumPoint(RobotModel& model)
    : model_(model),
      paths_(static_cast<size_t>(model.CableCount())),
      rest_paths_(paths_.size()),
      path_m_(paths_.size()),
      force_(paths_.size()) {
  EvaluateRestPaths();
}

/// Pull points may have moved.
void EquilibriumPoint::EvaluateRestPaths() {
  for (int c = 0; c < model_.CableCount(); ++c) {
    Eigen::Matrix3Xd& path_m = path_m_[At(c)];
    model_.cable(c).FindPath(model_.elastic_body().rest_m(), &path_m);
    rest_paths_[At(c)].Evaluate(path_m, {});
  }
}

void EquilibriumPoint::Set(const std::vector<ActuatorCommand>& commands,
                           const fem::StaticState& state) {
  PALPATE_CHECK(static_cast<int>(commands.size()) == model_.ActuatorCount(), commands.size());
  PALPATE_CHECK(state.x_m.size() == 3 * model_.elastic_body().NodeCount(), state.x_m.size());
  commands_ = commands;
  x_m_ = state.x_m;
  tension_N_ = state.multipliers_N;
  has_lame_forces_ = false;
  EvaluateRestPaths();
  for (int c = 0; c < model_.CableCount(); ++c) {
    const Cable& cable = model_.cable(c);
    Eigen::Matrix3Xd& path_m = path_m_[At(c)];
    cable.FindPath(x_m_, &path_m);
    paths_[At(c)].Evaluate(path_m, cable.friction());
  }
}

size_t EquilibriumPoint::Index(int actuator) const {
  PALPATE_CHECK(actuator >= 0 && actuator < model_.ActuatorCount(), actuator);
  return static_cast<size_t>(actuator);
}

bool EquilibriumPoint::KeepsLength(int actuator) const {
  const ActuatorTraits& limits = model_.traits(actuator);
  return command(actuator).kind == ActuatorCommand::Kind::kDisplacement &&
         tension_N(actuator) > limits.least_force_N && tension_N(actuator) < limits.most_force_N;
}

bool EquilibriumPoint::Holds(Eigen::Index node, Eigen::Index direction) const {
  return model_.linearisation().fixed()(direction, node);
}

const Eigen::VectorXd& EquilibriumPoint::force_on_base_N() const {
  return model_.linearisation().nodal_residual_N();
}

const fem::ElementDerivative& EquilibriumPoint::elements() const {
  if (!elements_) {
    elements_ = std::make_unique<fem::ElementDerivative>(model_.body().mesh,
                                                         model_.body().material_of_cell);
  }
  return *elements_;
}

const Eigen::VectorXd& EquilibriumPoint::nodal_volume_m3() const {
  if (nodal_volume_m3_.size() == 0) nodal_volume_m3_ = elements().NodalVolume_m3(-1);
  return nodal_volume_m3_;
}

const Eigen::VectorXd& EquilibriumPoint::NodalVolumeAlong(const Eigen::VectorXd& mode_m) const {
  if (mode_m_.size() == 0 || mode_m_ != mode_m) {
    volume_along_mode_ = elements().NodalVolumeAlong(mode_m);
    mode_m_ = mode_m;
  }
  return volume_along_mode_;
}

void EquilibriumPoint::EvaluateLameForces() const {
  if (has_lame_forces_) return;
  elements().LameForces(materials(), x_m_, &per_lambda_m2_, &per_mu_m2_);
  has_lame_forces_ = true;
}

const Eigen::MatrixXd& EquilibriumPoint::forces_per_lambda_m2() const {
  EvaluateLameForces();
  return per_lambda_m2_;
}

const Eigen::MatrixXd& EquilibriumPoint::forces_per_mu_m2() const {
  EvaluateLameForces();
  return per_mu_m2_;
}

void EquilibriumPoint::PathMotion(int cable, const Eigen::VectorXd& nodal_m,
                                  Eigen::Matrix3Xd* motion_m) const {
  const std::vector<fem::InterpolationWeights>& eyelets = model_.cable(cable).eyelets();
  motion_m->resize(3, ToIndex(eyelets.size()) + 1);
  motion_m->col(0).setZero();
  for (size_t e = 0; e < eyelets.size(); ++e) {
    motion_m->col(ToIndex(e) + 1) = eyelets[e].Position(nodal_m);
  }
}

void EquilibriumPoint::MovePath(int cable, const Eigen::Matrix3Xd& motion_m,
                                ParameterColumn* column) const {
  const CablePath& moved = path(cable);
  column->length_m[cable] += moved.LengthAlong(motion_m);
  Eigen::Matrix3Xd& force = force_[At(cable)];
  moved.ForceAlong(motion_m, &force);
  PullPath(cable, tension_N(cable), force, column);
}

void EquilibriumPoint::PullPath(int cable, double tension_N, const Eigen::Matrix3Xd& force,
                                ParameterColumn* column) const {
  if (tension_N == 0.0) return;
  const std::vector<fem::InterpolationWeights>& eyelets = model_.cable(cable).eyelets();
  for (size_t e = 0; e < eyelets.size(); ++e) {
    column->AddForce(eyelets[e], tension_N * force.col(ToIndex(e) + 1));
  }
}

/// The gradient is a quadratic function of the positions, so that its central difference is exact.
void EquilibriumPoint::MoveChamberWall(int actuator, const Eigen::VectorXd& motion_m,
                                       ParameterColumn* column) const {
  const Actuator& chamber = model_.actuator(actuator);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x_m_.size());
  chamber.AddGradient(x_m_, 1.0, gradient);
  column->length_m[actuator] += gradient.dot(motion_m);
  const double half_N = 0.5 * tension_N(actuator);
  if (half_N == 0.0) return;
  chamber.AddGradient(x_m_ + motion_m, -half_N, column->distributed_force_N());
  chamber.AddGradient(x_m_ - motion_m, half_N, column->distributed_force_N());
}

double EquilibriumPoint::RestLengthAlong(int actuator, const Eigen::VectorXd& mode_m) const {
  if (actuator < model_.CableCount()) {
    Eigen::Matrix3Xd motion_m;
    PathMotion(actuator, mode_m, &motion_m);
    return rest_path(actuator).LengthAlong(motion_m);
  }
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(mode_m.size());
  model_.actuator(actuator).AddGradient(model_.elastic_body().rest_m(), 1.0, gradient);
  return gradient.dot(mode_m);
}

void EquilibriumPoint::MoveHeldNode(Eigen::Index node, const Eigen::Vector3d& motion_m,
                                    ParameterColumn* column) const {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (Holds(node, i)) column->held_motion_m()[3 * node + i] += motion_m[i];
  }
}

void EquilibriumPoint::ApplyHeldMotion(ParameterColumn* column) const {
  if (!column->HasHeldMotion()) return;
  const Eigen::VectorXd& motion_m = column->held_motion_m();
  elements().AddAlongPositions(materials(), x_m_, motion_m, -1.0, column->distributed_force_N());
  model_.elastic_body().fibres().AddAlongPositions(x_m_, motion_m, -1.0,
                                                   column->distributed_force_N());
  for (int c = 0; c < model_.CableCount(); ++c) {
    Eigen::Matrix3Xd& path_motion_m = path_m_[At(c)];
    PathMotion(c, motion_m, &path_motion_m);
    MovePath(c, path_motion_m, column);
  }
  for (int c = model_.CableCount(); c < model_.ActuatorCount(); ++c) {
    MoveChamberWall(c, motion_m, column);
  }
}

void EquilibriumPoint::Complete(ParameterColumn* column) const {
  ApplyHeldMotion(column);
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    const double more_N = column->commanded_tension_N[c];
    if (command(c).kind != ActuatorCommand::Kind::kTension) PALPATE_CHECK(more_N == 0.0, c, more_N);
    if (c < model_.CableCount()) {
      PullPath(c, more_N, path(c).force(), column);
    } else if (more_N != 0.0) {
      model_.actuator(c).AddGradient(x_m_, -more_N, column->distributed_force_N());
    }
  }
}

}  // namespace palpate::robot
