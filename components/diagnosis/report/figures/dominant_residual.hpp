// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// What changes most in some samples: one marker's residual along one direction.
struct DominantResidual {
  Eigen::Index marker = -1;  ///< -1: nothing to be seen
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
};

using ComparedSamples = std::vector<const ComparedSample*>;

/// What varies most, from the residuals before about their mean over the samples; the sign is such
/// that the last half of the samples is at the positive side of the first.
DominantResidual FindDominant(const ComparedSamples& compared_samples);

/// What rises most with `x` [samples] (least squares), NaN: that sample does not count.
DominantResidual FindRise(const ComparedSamples& compared_samples, const std::vector<double>& x);

/// One residual along the direction, mm; NaN: not seen.
double Along_mm(const DominantResidual& dominant, const Eigen::Matrix3Xd& residual_m);

/// "marker tip, along (0.1, 0.9, -0.3)"
std::string DescribeDominant(const DominantResidual& dominant, const DiagnosisResult& result);

}  // namespace palpate::diagnosis
