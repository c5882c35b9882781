// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/load_place.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Whether no cable moves in the recording by more than the noise of actuators and sensors.
bool CablesAreStill(const experiment::Recording& recording);

/// Windows over which markers are averaged: one for a static phase, up to `most_frames` single
/// times for a motion, or for loads that change. The recording must have markers.
std::vector<experiment::TimeWindow> WindowsOf(const experiment::Recording& recording,
                                              int most_frames);

/// Cable inputs at this time of the recording, corrected by the model's actuators; kNone for a
/// cable without recorded input.
std::vector<robot::ActuatorCommand> CablesAt(const experiment::Recording& recording,
                                             const robot::RobotModel& model,
                                             robot::CableInput preferred, double t_s);

/// The known loads at that time. Throws InputError (file:line) where one lies off the body.
std::vector<robot::DeadLoad> LoadsAt(const experiment::Recording& recording,
                                     const robot::RobotModel& model, double t_s);
/// Where they act.
std::vector<LoadPlace> LoadPlacesAt(const experiment::Recording& recording, double t_s);

}  // namespace palpate::calibration
