// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "libs/fem/interpolation_weights.hpp"

namespace palpate::robot {

class EquilibriumPoint;

/// What a parameter p changes at fixed node positions and fixed cable tensions: the right-hand side
/// of the sensitivity equations. Everything is per unit of p.
class ParameterColumn {
 public:
  /// Back to "changes nothing". Memory is kept.
  void Reset(Eigen::Index nodal_size, Eigen::Index cables);

  /// d(f_ext - F_int - cable forces)/dp is what these two add up to. Entries of held directions are
  /// not used. What loads the body as a whole [3n]; 0 at first.
  Eigen::VectorXd& distributed_force_N();
  /// Adds a force on a point of the body.
  void AddForce(const fem::InterpolationWeights& point, const Eigen::Vector3d& force_N);
  /// dx/dp of the held directions [3n]; 0 at first. Entries of free directions stay 0.
  Eigen::VectorXd& held_motion_m();
  /// Adds `factor` times everything that another one changes.
  void Add(double factor, const ParameterColumn& other);

  const Eigen::VectorXd& distributed_force_N() const { return distributed_force_; }
  /// (node, force) of the forces on points; a node may be there several times.
  const std::vector<std::pair<int, Eigen::Vector3d>>& point_forces_N() const {
    return point_forces_;
  }
  /// Adds all forces to `nodal_N` [3n].
  void AddForceTo(Eigen::Ref<Eigen::VectorXd> nodal_N) const;
  const Eigen::VectorXd& held_motion_m() const { return held_motion_; }
  bool IsDistributed() const { return is_distributed_; }
  bool HasForce() const { return is_distributed_ || !point_forces_.empty(); }
  bool HasHeldMotion() const { return has_held_motion_; }

  /// [cables] derivative of each cable's length at fixed node positions.
  Eigen::VectorXd length_m;
  /// [cables] derivative of the length that a displacement command asks for. Of no effect on cables
  /// that are slack, at their tension limit, not driven or driven by tension.
  Eigen::VectorXd commanded_length_m;
  /// [cables] derivative of the tension that a tension command asks for; 0 for all other cables.
  Eigen::VectorXd commanded_tension_N;

 private:
  Eigen::Index nodal_size_ = 0;
  Eigen::VectorXd distributed_force_;
  std::vector<std::pair<int, Eigen::Vector3d>> point_forces_;
  Eigen::VectorXd held_motion_;
  bool is_distributed_ = false;
  bool has_held_motion_ = false;
};

/// Something that an equilibrium depends on, p: one right-hand side each. The kinds there are:
/// parameters.hpp.
class Parameter {
 public:
  virtual ~Parameter() = default;
  /// Fills `column`, which changes nothing yet.
  virtual void Describe(const EquilibriumPoint& at, ParameterColumn* column) const = 0;
};

using ParameterPtr = std::unique_ptr<const Parameter>;

}  // namespace palpate::robot
