// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/load_place.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Whether no cable moved, by more than drives and sensors tremble, in the whole recording.
bool CablesAreStill(const experiment::Recording& recording);

/// Windows to average markers over: a static phase is one, of a motion up to `most_frames` single
/// moments. The recording has markers.
std::vector<experiment::TimeWindow> WindowsOf(const experiment::Recording& recording,
                                              int most_frames);

/// What the cables were commanded at this time of the recording, as the model's drives read it;
/// kNone for a cable of which nothing was recorded.
std::vector<robot::CableCommand> CablesAt(const experiment::Recording& recording,
                                          const robot::RobotModel& model,
                                          robot::CableInput preferred, double t_s);

/// The known loads of that time. Throws InputError (file:line) where one lies off the body.
std::vector<robot::DeadLoad> LoadsAt(const experiment::Recording& recording,
                                     const robot::RobotModel& model, double t_s);
/// Where these act.
std::vector<LoadPlace> LoadPlacesAt(const experiment::Recording& recording, double t_s);

}  // namespace palpate::calibration
