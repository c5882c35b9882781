// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/monitor/held_motion.hpp"

namespace palpate::force_estimation {

struct MarkerMotionTuning {
  /// Residual chi-squared beyond its expectation, in its standard deviations, up to which a frame
  /// is used. Larger: frames with unknown contacts or a model error enter; smaller: fewer frames.
  double far_sigmas = 5.0;
};

/// The common rigid motion of all markers about `middle_m`, from the model to the measurement, as
/// far as forces at the frame's contacts do not explain it. A frame has no information (0) with
/// fewer than three markers, and where the residual after such a motion is beyond the markers'
/// noise: something else acts on the robot, or the model is wrong.
MotionSighting SeeMotion(const MarkerMisfit& misfit, const Eigen::Matrix3Xd& model_m,
                         const Eigen::Vector3d& middle_m, const MarkerMotionTuning& tuning = {});

}  // namespace palpate::force_estimation
