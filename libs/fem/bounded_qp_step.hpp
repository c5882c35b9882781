// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>

#include "libs/fem/bounded_qp.hpp"

namespace palpate::fem {

/// Slopes of directions without curvature, in units of the terms that they are the sum of: what is
/// less may be rounding in the caller's c, and a step along it would go far for nothing.
inline constexpr double kFlatSlope = 1e-9;

/// The part of a bounded QP that its free variables see. H's diagonal lies within 1/2..2, or is 0.
struct FreeBlock {
  std::array<Eigen::Index, kMaxQpVariables> variable{};  ///< which one each row stands for
  QpMatrix H;
  QpVector gradient;
  QpVector magnitude;  ///< size of the terms that each entry of the gradient is the sum of
  /// The gradient without what is flat or rounding, where that is known: all but one variable are
  /// at their minimum just after a bound was released.
  QpVector descent;
};

enum class StepKind {
  kToMinimum,  ///< the smallest step to where the gradient vanishes, but for flat slopes
  kRay,        ///< a unit vector downhill along which there is no curvature to rely on
  kFailed,
};

/// One step from where the gradient was taken: by Cholesky, or, where the block is singular or
/// nearly so, by an eigen-decomposition. `step` has the block's size.
StepKind StepOf(const FreeBlock& block, QpVector* step);

}  // namespace palpate::fem
