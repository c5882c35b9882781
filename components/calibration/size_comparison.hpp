// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>

namespace palpate::calibration {

/// Compares the size of what was seen with that of the model, whatever lies where: RMS distances of
/// points from the middle of their picture, over all pictures.
class SizeComparison {
 public:
  /// [3 x n] points of one picture and those of the model, in the same order.
  void Add(const Eigen::Matrix3Xd& seen_m, const Eigen::Matrix3Xd& model_m);

  double seen_m() const;
  double model_m() const;
  /// By more than the cables make of a robot's size.
  bool Disagrees() const;
  /// And by so much that this, and not places that are wrong, left the residual (RMS distance).
  bool Explains(double residual_rms_m) const;
  /// "the sizes disagree: ...", with both numbers; `what` lies there.
  std::string Text(const std::string& what = "markers") const;

 private:
  double seen_squares_m2_ = 0.0, model_squares_m2_ = 0.0;
  double count_ = 0.0;
};

}  // namespace palpate::calibration
