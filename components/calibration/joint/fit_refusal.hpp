// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/calibration/joint/fit_check.hpp"
#include "components/calibration/joint/joint_request.hpp"

namespace palpate::calibration {

/// The camera's pose, where the fit moved it away from JointRequest::pose_prior; null: it did not.
const AdjustedPose* MovedCamera(const FitCheck& check, const JointRequest& request);

/// By how much a pose is off what is stated, for messages.
std::string OffBy(const AdjustedPose& pose);

/// Why no such robot can have been measured: the fit failed, its markers are farther from the model
/// than noise and tolerances put them, or it moved a stated pose other than the camera's. Empty: it
/// can.
std::string WhyRefused(const robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                       const JointCalibration& fit, const JointRequest& request);

}  // namespace palpate::calibration
