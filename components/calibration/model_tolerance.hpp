// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::calibration {

/// What a sound model of a robot errs by. Larger values accept worse fits. Measured robots fit
/// within a third of them (docs/benchmarks.md).
struct ModelTolerance {
  double placement_share = 0.005;  ///< of the body's extent: where a marker or a surface is
  double motion_share = 0.03;      ///< of a point's motion
};

/// Variance of a point of the model along one axis, m^2.
inline double ModelVariance_m2(double extent_m, double motion_m,
                               const ModelTolerance& tolerance = {}) {
  const double placement_m = tolerance.placement_share * extent_m;
  const double bent_m = tolerance.motion_share * motion_m;
  return placement_m * placement_m + bent_m * bent_m;
}

}  // namespace palpate::calibration
