// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/faults/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::diagnosis {

double Quantile(double probability, const TwoParameters& of, double largest,
                const std::function<double(double value, double second)>& z_at) {
  constexpr int kSlices = 81;
  constexpr double kFarthest = 4.0;  // sigma
  constexpr int kHalvings = 60;
  const Eigen::Matrix2d& covariance = of.covariance;
  const double sigma = std::sqrt(covariance(1, 1));
  const double slope = sigma > 0.0 ? covariance(0, 1) / covariance(1, 1) : 0.0;
  const double rest = std::sqrt(std::max(covariance(0, 0) - slope * covariance(0, 1), 1e-12));
  const auto is_less = [&](double value) {
    double less = 0.0;
    double all = 0.0;
    for (int k = 0; k < kSlices; ++k) {
      const double t = kFarthest * (2.0 * k / (kSlices - 1) - 1.0);
      const double weight = std::exp(-0.5 * t * t);
      const double first = of.z[0] + slope * sigma * t;
      const double at = z_at(value, std::clamp(of.z[1] + sigma * t, of.least, of.most));
      less += weight * 0.5 * std::erfc((first - at) / (std::numbers::sqrt2 * rest));
      all += weight;
    }
    return less / all;
  };
  double low = 0.0;
  double high = largest;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (is_less(middle) < probability ? low : high) = middle;
  }
  return low;
}

}  // namespace palpate::diagnosis
