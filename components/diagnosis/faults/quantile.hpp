// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>

namespace palpate::diagnosis {

/// Of two parameters z with this covariance, each kept where it can be, the second in [`least`,
/// `most`].
struct TwoParameters {
  Eigen::Vector2d z;
  Eigen::Matrix2d covariance;
  double least;
  double most;
};

/// The value below which a quantity in [0, `largest`] lies with this probability. It grows with
/// z[0], and changes in any way with z[1], of which many values stand for as much of the prior of
/// it each: `z_at`(value, z[1]) is the z[0] at which it has that value, infinity where none is
/// large enough.
double Quantile(double probability, const TwoParameters& of, double largest,
                const std::function<double(double value, double second)>& z_at);

}  // namespace palpate::diagnosis
