// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>

namespace palpate::calibration {

/// Compares the size of measured points with that of the model, independently of pose: RMS
/// distances of points from the centroid of their frame, over all frames.
class SizeComparison {
 public:
  /// [3 x n] points of one frame and those of the model, in the same order.
  void Add(const Eigen::Matrix3Xd& seen_m, const Eigen::Matrix3Xd& model_m);

  double seen_m() const;
  double model_m() const;
  /// By more than cables change the size of a robot.
  bool Disagrees() const;
  /// And the difference is large enough to cause this residual (RMS distance).
  bool Explains(double residual_rms_m) const;
  /// "the sizes disagree: ...", with both numbers; `what`: the kind of points.
  std::string Text(const std::string& what = "markers") const;

 private:
  double seen_squares_m2_ = 0.0, model_squares_m2_ = 0.0;
  double count_ = 0.0;
};

}  // namespace palpate::calibration
