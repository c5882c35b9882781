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

/// Below which a quantity in [0, `largest`] is with this probability that grows with z[0], and of
/// z[1] may be any function: `z_at`(value, z[1]) is the z[0] at which it has the value. Each of
/// many z[1] stands for as much of what is believed of it.
double Quantile(double probability, const TwoParameters& of, double largest,
                const std::function<double(double value, double second)>& z_at);

}  // namespace palpate::diagnosis
