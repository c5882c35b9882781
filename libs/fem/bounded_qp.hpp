// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>

#include "libs/core/status.hpp"
#include "libs/linalg/small_matrix.hpp"

namespace palpate::fem {

inline constexpr int kMaxQpVariables = linalg::kMaxSmallSize;
using QpVector = linalg::SmallVector;
using QpMatrix = linalg::SmallMatrix;

/// min 1/2 x' H x + c' x subject to lower <= x <= upper; H symmetric positive semidefinite (of a
/// matrix that is not quite symmetric, the mean with its transpose counts).
struct BoundedQp {
  QpMatrix H;
  QpVector c;
  QpVector lower;  ///< may hold -infinity
  QpVector upper;  ///< may hold +infinity
};

struct BoundedQpResult {
  Status status;
  QpVector x;  ///< the start where the status is not ok
  int iterations = 0;
  /// Largest violation of the optimality conditions after scaling H's diagonal to 1/2..2, in units
  /// of the largest sum |c_i| + sum_j |H_ij x_j| (or 1/256 of what it was a step before, where that
  /// is more: the minimum may be at zero). Rounding alone leaves some 1e-14.
  double kkt_residual = std::numeric_limits<double>::infinity();
};

/// Primal active-set method (Nocedal & Wright, Numerical Optimization, 2nd ed., algorithm 16.3) on
/// scaled variables; nothing is allocated. `start` is clipped into the bounds and gives which of
/// them are active at first: the solution of a neighbouring problem is a warm start, and one
/// iteration is enough where the active bounds are still the same.
/// Where H is singular along a direction without a bound, the smallest step along it is taken. A
/// slope below 1e-9 of the terms that it is the sum of counts as flat there.
/// kUnobservable: the objective falls without end. kInvalidInput: NaN, bounds that cross or leave
/// no finite value, an infinite H, c or start, or magnitudes that overflow once scaled.
/// kNotConverged: iterations used up (not seen with a positive semidefinite H).
BoundedQpResult SolveBoundedQp(const BoundedQp& qp, const QpVector& start);

}  // namespace palpate::fem
