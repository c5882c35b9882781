// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "libs/core/index.hpp"

namespace palpate {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// What rounding made 0 or 1, as 1 - 1e-17, counts as the nearest number that is neither.
constexpr double kNearestToZero = std::numeric_limits<double>::min();
constexpr double kNearestToOne = 1.0 - 0.5 * std::numeric_limits<double>::epsilon();

double Tail(double q) {
  return (((((-7.784894002430293e-03 * q - 3.223964580411365e-01) * q - 2.400758277161838e+00) * q -
            2.549732539343734e+00) *
               q +
           4.374664141464968e+00) *
              q +
          2.938163982698783e+00) /
         ((((7.784695709041462e-03 * q + 3.224671290700398e-01) * q + 2.445134137142996e+00) * q +
           3.754408661907416e+00) *
              q +
          1.0);
}

double Centre(double q) {
  const double r = q * q;
  return (((((-3.969683028665376e+01 * r + 2.209460984245205e+02) * r - 2.759285104469687e+02) * r +
            1.383577518672690e+02) *
               r -
           3.066479806614716e+01) *
              r +
          2.506628277459239e+00) *
         q /
         (((((-5.447609879822406e+01 * r + 1.615858368580409e+02) * r - 1.556989798598866e+02) * r +
            6.680131188771972e+01) *
               r -
           1.328068155288572e+01) *
              r +
          1.0);
}

}  // namespace

double Mean(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Median(std::vector<double> values) {
  if (values.empty()) return kNone;
  const double upper = UpperMedian(values);
  if (values.size() % 2 == 1) return upper;
  const auto middle = values.begin() + std::ssize(values) / 2;
  return 0.5 * (upper + *std::max_element(values.begin(), middle));
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNone;
  const auto count = static_cast<double>(values.size());
  const auto index = static_cast<std::ptrdiff_t>(std::clamp(share * count, 0.0, count - 1.0));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[At(index)];
}

double NormalQuantile(double probability) {
  PALPATE_CHECK(probability >= 0.0 && probability <= 1.0, probability);
  probability = std::clamp(probability, kNearestToZero, kNearestToOne);
  constexpr double kLow = 0.02425;
  if (probability < kLow) return Tail(std::sqrt(-2.0 * std::log(probability)));
  if (probability > 1.0 - kLow) return -Tail(std::sqrt(-2.0 * std::log1p(-probability)));
  return Centre(probability - 0.5);
}

double ChiSquaredQuantile(double probability, int degrees) {
  PALPATE_CHECK(degrees >= 1, degrees);
  PALPATE_CHECK(probability >= 0.0 && probability <= 1.0, probability);
  probability = std::min(probability, kNearestToOne);
  if (degrees == 1) return std::pow(NormalQuantile(0.5 * (1.0 + probability)), 2);
  if (degrees == 2) return -2.0 * std::log1p(-probability);
  const double variance = 2.0 / (9.0 * degrees);
  const double root = 1.0 - variance + NormalQuantile(probability) * std::sqrt(variance);
  return degrees * root * root * root;
}

}  // namespace palpate
