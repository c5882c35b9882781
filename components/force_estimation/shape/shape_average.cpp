// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_average.hpp"

#include <algorithm>
#include <cmath>

#include "components/force_estimation/shape/temporal_correlation.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

/// Of a single frame's variance in the mean.
double ShareLeft(int frames) { return std::min(1.0, kTemporalCorrelation / frames); }

}  // namespace

void ShapeAverage::Forget() {
  frames_ = 0;
  for (Mean& mean : means_) mean.count = 0;
}

const ShapeAverage::Mean& ShapeAverage::MeanOf(std::size_t match) const {
  static const Mean kUnseen;
  return match < means_.size() ? means_[match] : kUnseen;
}

bool ShapeAverage::Fits(const ShapeTargets& targets, const Eigen::VectorXd& motion_m) const {
  double sum = 0.0;
  int known = 0;
  for (std::size_t r = 0; r < targets.matched().size(); ++r) {
    const auto row = ToIndex(r);
    const auto [mean_m, count] = MeanOf(targets.matched()[r]);
    if (count == 0) continue;
    const double sigma_m = targets.noise_m()[row] * std::sqrt(1.0 + ShareLeft(count));
    sum += std::pow((motion_m[row] - mean_m) / sigma_m, 2);
    ++known;
  }
  return sum <= tuning_.moved_chi_squared * known;
}

void ShapeAverage::Add(const ShapeTargets& targets, const Eigen::VectorXd& motion_m) {
  if (!Fits(targets, motion_m)) Forget();
  ++frames_;
  motion_m_.resize(motion_m.size());
  weight_.resize(motion_m.size());
  if (!targets.matched().empty()) {
    means_.resize(std::max(means_.size(), targets.matched().back() + 1));
  }
  for (std::size_t r = 0; r < targets.matched().size(); ++r) {
    const auto row = ToIndex(r);
    auto& [mean_m, count] = means_[targets.matched()[r]];
    count = std::min(count + 1, tuning_.most_frames);
    mean_m += (motion_m[row] - mean_m) / count;
    motion_m_[row] = mean_m;
    const double whole_m2 = std::pow(targets.sigma_m()[row], 2);
    const double noise_m2 = std::pow(targets.noise_m()[row], 2);
    const double share = targets.targets().weight[row] * whole_m2;
    weight_[row] = share / (whole_m2 - (1.0 - ShareLeft(count)) * noise_m2);
  }
}

}  // namespace palpate::force_estimation
