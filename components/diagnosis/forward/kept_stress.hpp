// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "libs/fem/load_state.hpp"
#include "libs/fem/node_matrix.hpp"
#include "libs/fem/point_stress.hpp"
#include "libs/fem/scalar_constraint.hpp"

namespace palpate::diagnosis {

/// Second Piola-Kirchhoff stresses at the integration points of a body [6 x points], Pa, as
/// fem::PointStress has them; such as are kept of many samples.
using PointStresses = Eigen::Matrix<float, 6, Eigen::Dynamic>;

/// A stress that stays with the material while the body moves on: the history variable of creep. As
/// a constraint its energy g(x) = x' L x / 2, J (fem::PointStress::SetMatrix), with a multiplier of
/// 1 where there is such a stress.
class KeptStress final : public fem::ScalarConstraint {
 public:
  /// `mesh` must outlive it.
  explicit KeptStress(const fem::TetMesh& mesh) : mesh_(mesh) {}

  /// None where `stress_Pa` is empty.
  void Set(const fem::PointStress& points, const PointStresses& stress_Pa);
  fem::ConstraintCommand Command() const;

  double Value(const Eigen::VectorXd& x_m) const override;
  void AddGradient(const Eigen::VectorXd& x_m, double factor,
                   Eigen::VectorXd& nodal) const override;
  fem::NodePairs CoupledPairs() const override { return {}; }  // the elements' own
  void BindTo(const fem::StiffnessMatrix& stiffness) override { stiffness_ = &stiffness; }
  void AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                    fem::StiffnessMatrix& stiffness) const override;

 private:
  const fem::TetMesh& mesh_;
  const fem::StiffnessMatrix* stiffness_ = nullptr;
  std::optional<fem::NodeMatrix> matrix_;  ///< L, made when it is needed first
  bool is_there_ = false;
};

}  // namespace palpate::diagnosis
