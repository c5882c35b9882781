// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/size_comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace palpate::calibration {

namespace {

struct SizeComparisonTuning {
  double disagreement = 0.05;  ///< relative difference: less may be that of cables and noise
  /// Largest residual over the difference of the sizes: a registration leaves the difference
  /// itself, and noise adds to it.
  double most_of_difference = 1.5;
};
constexpr SizeComparisonTuning kSizeTuning;

double SquaresAboutMiddle_m2(const Eigen::Matrix3Xd& points_m) {
  if (points_m.cols() == 0) return 0.0;
  const Eigen::Vector3d middle_m = points_m.rowwise().mean();
  return (points_m.colwise() - middle_m).squaredNorm();
}

}  // namespace

void SizeComparison::Add(const Eigen::Matrix3Xd& seen_m, const Eigen::Matrix3Xd& model_m) {
  seen_squares_m2_ += SquaresAboutMiddle_m2(seen_m);
  model_squares_m2_ += SquaresAboutMiddle_m2(model_m);
  count_ += static_cast<double>(seen_m.cols());
}

double SizeComparison::seen_m() const {
  return std::sqrt(seen_squares_m2_ / std::max(1.0, count_));
}

double SizeComparison::model_m() const {
  return std::sqrt(model_squares_m2_ / std::max(1.0, count_));
}

bool SizeComparison::Disagrees() const {
  return std::abs(seen_m() - model_m()) > kSizeTuning.disagreement * model_m();
}

bool SizeComparison::Explains(double residual_rms_m) const {
  return Disagrees() &&
         residual_rms_m <= kSizeTuning.most_of_difference * std::abs(seen_m() - model_m());
}

std::string SizeComparison::Text(const std::string& what) const {
  std::array<char, 256> text;
  std::snprintf(text.data(), text.size(),
                "the sizes disagree: %s are %.2f mm from their centre (RMS), those of the "
                "model %.2f mm: another robot, or one %.2f times as large as its file says",
                what.c_str(), 1e3 * seen_m(), 1e3 * model_m(), seen_m() / model_m());
  return text.data();
}

}  // namespace palpate::calibration
