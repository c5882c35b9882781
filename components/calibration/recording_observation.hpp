// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/calibration/material_calibration.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The static phase of a recording for CalibrateMaterial: marker means over the steady window
/// (absent: the whole recording), cable inputs and known loads at its middle, gravity turned with
/// the base. The variance of a mean is the noise variance (measured, at least markers_sigma_m of
/// the experiment) over the number of frames, plus `marker_bias_m` squared.
/// Throws InputError (file:line) as force_estimation's reading of recordings does, and where no
/// frame lies in a window.
StaticObservation ObserveRecording(const experiment::Experiment& experiment,
                                   const experiment::Recording& recording,
                                   const robot::RobotModel& model, robot::CableInput preferred,
                                   double marker_bias_m);

}  // namespace palpate::calibration
