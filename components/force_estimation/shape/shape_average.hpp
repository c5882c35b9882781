// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "components/force_estimation/shape/shape_targets.hpp"

namespace palpate::force_estimation {

struct ShapeAverageTuning {
  /// Largest number of frames in the mean; older ones fade out. More: less noise, a slower response
  /// to creep.
  int most_frames = 20;
  /// Mean square of a frame's difference from the mean, over the noise, that restarts the average.
  /// Smaller: noise restarts it; larger: a moving contact is averaged over its path.
  double moved_chi_squared = 2.5;
};

/// Displacement of the surface points due to contacts, averaged over the frames in which it is
/// constant: a hidden contact is located from all of these frames.
class ShapeAverage {
 public:
  explicit ShapeAverage(const ShapeAverageTuning& tuning = {}) : tuning_(tuning) {}

  void Forget();
  /// A frame: `motion_m` of the rows of `targets`. One that differs from the mean by more than the
  /// noise restarts the average.
  void Add(const ShapeTargets& targets, const Eigen::VectorXd& motion_m);

  int frames() const { return frames_; }  ///< since the last restart
  /// Means of the rows of the frame that was added last, m, and their weights: 1 / variance of
  /// the averaged noise and the constant error.
  const Eigen::VectorXd& motion_m() const { return motion_m_; }
  const Eigen::VectorXd& weight() const { return weight_; }

 private:
  bool Fits(const ShapeTargets& targets, const Eigen::VectorXd& motion_m) const;
  /// Of a surface point that a camera sees, ShapeTargets::matched.
  struct Mean {
    double motion_m = 0.0;
    int count = 0;
  };
  const Mean& MeanOf(std::size_t match) const;

  ShapeAverageTuning tuning_;
  int frames_ = 0;
  std::vector<Mean> means_;  ///< [matches seen so far]
  Eigen::VectorXd motion_m_;
  Eigen::VectorXd weight_;
};

}  // namespace palpate::force_estimation
