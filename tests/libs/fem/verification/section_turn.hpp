// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/scalar_constraint.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem::verification {

/// Minus the angle by which the last of several sections of a straight beam along x has turned in
/// the x-z plane, from z towards +x (the beam bends downwards). The multiplier is then the end
/// moment, N m: dg/dx spreads it over the section as a linear bending stress that turns along.
///
/// A section's director is d = sum_i w_i x_i with w_i its nodes' height above its middle (over the
/// sum of their squares); the angle is added up from section to section, so that it goes on
/// beyond a full turn. The first section must be held.
class SectionTurn : public ScalarConstraint {
 public:
  /// `stations_m`: rest x of the sections, rising; each needs nodes at two heights or more.
  SectionTurn(const TetMesh& mesh, const std::vector<double>& stations_m);

  double Value(const Eigen::VectorXd& x_m) const override;
  void AddGradient(const Eigen::VectorXd& x_m, double factor,
                   Eigen::VectorXd& nodal) const override;
  NodePairs CoupledPairs() const override;
  void BindTo(const StiffnessMatrix& stiffness) override;
  void AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                    StiffnessMatrix& stiffness) const override;

 private:
  struct Section {
    std::vector<int> nodes;
    std::vector<double> weights;  ///< 1/m

    Eigen::Vector3d Director(const Eigen::VectorXd& x_m) const;
  };

  std::vector<Section> sections_;
  std::vector<BlockSlot> slots_;  ///< pairs of the last section's nodes
};

}  // namespace palpate::fem::verification
