// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "libs/core/check.hpp"

/// Sample statistics, quantiles of distributions and Huber's loss, once for all.
namespace palpate {

/// Arithmetic mean, summed from the first value on. NaN: no values.
double Mean(const std::vector<double>& values);

/// Median; of an even number of values the mean of the two in the middle. NaN: no values.
double Median(std::vector<double> values);

/// The sorted values' element number floor(share * count), counted from 0 and at most the last:
/// for a share of 0.5 UpperMedian. `share` from 0 to 1. NaN: no values.
double Quantile(std::vector<double> values, double share);

/// Median; of an even number of values the upper of the two in the middle. Reorders `values`
/// (random access, at least one) and allocates nothing.
template <typename Values>
auto UpperMedian(Values&& values) {
  const auto begin = std::begin(values), end = std::end(values);
  PALPATE_CHECK(begin != end);
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end);
  return *middle;
}

/// Quantile of the standard normal distribution, 0 <= probability <= 1 (Acklam's rational
/// approximation, 1e-9). Always finite: 0 and 1 count as the numbers next to them (-37.5 and 8.2),
/// as 1 - chance is 1 for a chance below 1e-16.
double NormalQuantile(double probability);

/// Quantile of the chi-squared distribution with `degrees` >= 1 degrees of freedom: exact for one
/// and two, else Wilson and Hilferty's cube root, good to 2 % for probabilities from 0.5 to 0.999.
/// 0 <= probability <= 1, 1 as above.
double ChiSquaredQuantile(double probability, int degrees);

/// Half-width of a normal distribution's 95 % interval, in standard deviations.
inline constexpr double kSigmas95 = 1.959963984540054;
/// Radius that holds 95 % of an isotropic normal distribution in two dimensions, in standard
/// deviations: sqrt(ChiSquaredQuantile(0.95, 2)).
inline constexpr double kSigmas95InPlane = 2.447746830680816;

/// Huber's weight of a residual of this norm (>= 0, in the unit of `threshold`): 1 up to the
/// threshold, then threshold / norm. 1 where the threshold is not above 0. (P. J. Huber, Ann. Math.
/// Stat. 35 (1964) 73.)
inline double HuberWeight(double norm, double threshold) {
  return threshold > 0.0 && norm > threshold ? threshold / norm : 1.0;
}

}  // namespace palpate
