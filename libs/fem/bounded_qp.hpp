// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/core/status.hpp"

namespace palpate::fem {

inline constexpr int kMaxQpVariables = 16;
/// Small vectors and matrices without heap memory.
using QpVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxQpVariables, 1>;
using QpMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxQpVariables, kMaxQpVariables>;

/// min 1/2 x' H x + c' x subject to lower <= x <= upper; H symmetric positive semidefinite.
struct BoundedQp {
  QpMatrix H;
  QpVector c;
  QpVector lower;  ///< may hold -infinity
  QpVector upper;  ///< may hold +infinity
};

struct BoundedQpResult {
  Status status;
  QpVector x;
  int iterations = 0;
  /// Largest violation of the optimality conditions, in units of max |c| after scaling H's
  /// diagonal to one.
  double kkt_residual = 0.0;
};

/// Primal active-set method on scaled variables. `start` is clipped into the bounds and tells which
/// of them are active at first (warm start). Where H is singular along a direction without a bound,
/// the smallest step along it is taken; a problem without a minimum is kUnobservable.
BoundedQpResult SolveBoundedQp(const BoundedQp& qp, const QpVector& start);

}  // namespace palpate::fem
