// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/monitor/held_motion.hpp"

namespace palpate::force_estimation {

/// The motion about `middle_m` that all markers seem to have made together, from where the model
/// has them onto where they were seen. Whatever the forces at the frame's contacts could have made
/// of it is not counted as motion. A frame says nothing (information 0) where fewer than three
/// markers were used, and where such a motion leaves more than five standard deviations of
/// chi-squared beyond the markers' noise: something else acts on the robot, or the model is wrong.
MotionSighting SeeMotion(const MarkerMisfit& misfit, const Eigen::Matrix3Xd& model_m,
                         const Eigen::Vector3d& middle_m);

}  // namespace palpate::force_estimation
