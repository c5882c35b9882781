// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Throws RunError with the reason (FailureText) where a fit failed.
void RequireFit(const Status& status);
std::string FailureText(const Status& status);

/// What is not determined, how nearly, and the remedy.
std::string UndeterminedText(const robot::Undetermined& number);

/// How well a fit (calibration::MaterialCalibration, JointCalibration) came out.
template <typename Fit>
void TakeQuality(const Fit& fit, robot::CalibrationFile* file) {
  file->residual_rms_m = fit.residual_rms_m;
  file->chi_squared = fit.chi_squared;
  file->degrees_of_freedom = fit.degrees_of_freedom;
}

/// Prints it on the standard output, as text or as JSON.
void PrintCalibration(const robot::CalibrationFile& calibration);
void PrintCalibrationJson(const robot::CalibrationFile& calibration);

}  // namespace palpate::command
