// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/misfit_reasons.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The joint calibration from these frames. A prior of the camera pose that contradicts the markers
/// is left out, which is printed. Throws RunError where the fit fails or cannot be, with the likely
/// reasons.
calibration::JointCalibration FitMarkers(const std::vector<calibration::CalibrationFrame>& frames,
                                         calibration::JointRequest request,
                                         robot::RobotModel* model);

/// Throws RunError, with the likely reasons, for a fit that cannot be (calibration::WhyRefused).
void RequirePossible(const std::vector<calibration::CalibrationFrame>& frames,
                     const calibration::JointCalibration& fit,
                     const calibration::JointRequest& request, robot::RobotModel* model);

/// The recording that would determine a modulus that these do not: with known loads that are larger
/// than theirs, which are named, or with one at all.
std::string WhatTellsAModulus(const std::vector<const experiment::Recording*>& recordings);

/// Says of moduli that were not determined which known loads counted.
void NameKnownLoads(const std::vector<const experiment::Recording*>& recordings,
                    robot::CalibrationFile* file);

/// Throws RunError where nothing was determined.
void RequireSomething(const robot::CalibrationFile& file);

}  // namespace palpate::command
