// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/pose/frame_assignment.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// As FramesOfRecording (joint/recording_frames.hpp), for points whose names have no meaning. Each
/// point of the time with most points is averaged with the nearest one of every other time of the
/// window, if that is within kStillMarker_m.
std::vector<UnlabelledFrame> UnlabelledFramesOfRecording(const experiment::Experiment& experiment,
                                                         const experiment::Recording& recording,
                                                         const robot::RobotModel& model,
                                                         robot::CableInput preferred,
                                                         double marker_bias_m, int most_frames = 6);

}  // namespace palpate::calibration
