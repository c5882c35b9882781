// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/calibration/joint/joint_request.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::calibration {

/// What a calibration left open counts in the pose of a further camera of the same robot: its fit
/// estimates the actuators' offsets, and the sensors' zeros and gains, again, with the standard
/// errors of `file` as priors. Nothing else of the robot is estimated.
JointRequest RequestAfter(const robot::CalibrationFile& file);

}  // namespace palpate::calibration
