// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"

namespace palpate::robot {

/// A sparse row over the reduced system (fem/stiffness_matrix.hpp).
struct NodalRow {
  std::vector<std::pair<int, Eigen::Vector3d>> entries;  ///< (free node, its three entries)

  double Dot(const Eigen::Ref<const Eigen::VectorXd>& column) const;
  void AddTo(Eigen::Ref<Eigen::VectorXd> column) const;
};

/// What the actuators of an equilibrium are in the sensitivity equations (sensitivity_solver.hpp):
/// rows over the reduced system for their lengths (Actuator::Value), and for friction of cables, by
/// which K gains sum_i A_i B_i' with one rank for each turn i: B_i = dangle/dx, A_i = -T
/// dforce/dangle. Buffers grow at first. For one thread.
class CableTerms {
 public:
  /// Must outlive it.
  explicit CableTerms(const EquilibriumPoint& point) : point_(point) {}

  /// At the point's present equilibrium.
  void Evaluate();

  /// Those that keep the length that is commanded; chambers among them their volume.
  const std::vector<int>& taut() const { return taut_; }
  Eigen::Index TautCount() const { return ToIndex(taut_.size()); }
  Eigen::Index TurnCount() const { return ToIndex(angles_.size()); }
  const std::vector<NodalRow>& lengths() const { return lengths_; }  ///< [actuators] dlength/dx
  const std::vector<NodalRow>& angles() const { return angles_; }    ///< [turns] B
  /// Fills A [Size x turns].
  void FillTurnForces(Eigen::Ref<Eigen::MatrixXd> columns);
  /// Gives the taut cables what tension keeps them at the lengths that are commanded, as far as
  /// they do not stretch under it. All [cables x p]; `per_tension` [cables x taut]
  /// dlength/dtension. `length_m` and `tension_N` are those at fixed tensions of taut cables
  /// before, and what they are after. kUnobservable where two taut cables have linearly dependent
  /// effects.
  Status HoldLengths(const fem::QpMatrix& per_tension, const Eigen::MatrixXd& commanded_length_m,
                     Eigen::MatrixXd* length_m, Eigen::MatrixXd* tension_N) const;

 private:
  bool Rubs(int cable) const;
  void FillChamberRow(int actuator, NodalRow* row);
  void FillRow(int cable, const Eigen::Matrix3Xd& per_point, NodalRow* row) const;

  const EquilibriumPoint& point_;
  std::vector<int> taut_;
  std::vector<NodalRow> lengths_, angles_;
  Eigen::Matrix3Xd turn_force_, turn_angle_;
  ParameterColumn turn_column_;
  Eigen::VectorXd nodal_;  ///< [3n]
};

/// (I + B' K^-1 A)^-1 right, in its place, for `coupling` = B' K^-1 A or its transpose.
/// kUnobservable where friction leaves the equilibrium undetermined.
Status UndoTurns(Eigen::MatrixXd coupling, Eigen::MatrixXd* right);

}  // namespace palpate::robot
