// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/joint/unknown.hpp"

/// What the pressure sensor of a chamber adds to what it reads: the chamber has the pressure
/// (1 + g) p + zero where it reads p (robot::CalibratedPressureSensor). In a frame without a
/// reading the chamber is open to the air, and neither acts.
namespace palpate::calibration {

/// zero, Pa; `area_m2`: of the piston that stands for the chamber.
UnknownPtr PressureZero(int actuator, const std::string& chamber, double area_m2,
                        const GaussianPrior& prior);
/// g; `read_N`: thrust of the piston at the reading, one per frame, 0 without one;
/// `what_would_tell` as of Unknown.
UnknownPtr PressureGain(int actuator, const std::string& chamber, std::vector<double> read_N,
                        const GaussianPrior& prior, std::string what_would_tell);

}  // namespace palpate::calibration
