// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::fem {

/// A scalar function g(x) of the node positions through which a force acts: the length of a cable,
/// the volume of a chamber.
/// With multiplier lambda it contributes lambda dg/dx to the internal forces (the body is pushed
/// towards smaller g) and lambda d2g/dx2 to the tangent.
class ScalarConstraint {
 public:
  virtual ~ScalarConstraint() = default;

  virtual double Value(const Eigen::VectorXd& x_m) const = 0;
  /// Adds factor * dg/dx to `nodal` [3n].
  virtual void AddGradient(const Eigen::VectorXd& x_m, double factor,
                           Eigen::VectorXd& nodal) const = 0;
  /// Nodes that d2g/dx2 couples.
  virtual NodePairs CoupledPairs() const = 0;
  /// Looks up its blocks once; AddCurvature needs it.
  virtual void BindTo(const StiffnessMatrix& stiffness) = 0;
  /// Adds multiplier * d2g/dx2.
  virtual void AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                            StiffnessMatrix& stiffness) const = 0;
};

}  // namespace palpate::fem
