// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::fem {

/// What is asked of one constraint.
struct ConstraintCommand {
  enum class Mode {
    kOff,         ///< multiplier 0
    kMultiplier,  ///< multiplier given (cable tension, N)
    /// g(x) <= Bound_m, min_multiplier_N <= multiplier <= max_multiplier_N. Above the least
    /// multiplier g is at its bound.
    kUpperBound,
  };
  Mode mode = Mode::kOff;
  double value = 0.0;  ///< N for kMultiplier, m for kUpperBound
  double max_multiplier_N = std::numeric_limits<double>::infinity();
  double min_multiplier_N = 0.0;  ///< <= 0; below 0 for what can pull as well as push (a chamber)
  /// Of kUpperBound: compliance of the bound under its multiplier. Negative where the body
  /// is stiffer there than modelled; with the compliance of the body it is positive.
  double compliance_m_N = 0.0;

  double Bound_m(double multiplier_N) const { return value + compliance_m_N * multiplier_N; }
};

/// Everything that loads the body.
struct LoadState {
  Eigen::VectorXd external_force_N;  ///< [3n] dead nodal loads
  std::vector<ConstraintCommand> commands;
  /// [3n]; only entries of fixed directions are used.
  Eigen::VectorXd fixed_position_m;

  Eigen::Index CommandCount() const { return ToIndex(commands.size()); }
  const ConstraintCommand& command(Eigen::Index c) const { return commands[At(c)]; }
};

/// A configuration with the loads it was last brought into balance with.
struct StaticState {
  Eigen::VectorXd x_m;            ///< [3n]
  Eigen::VectorXd multipliers_N;  ///< [constraints]
  LoadState loads;
};

}  // namespace palpate::fem
