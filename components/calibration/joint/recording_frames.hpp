// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The markers of a recording as a joint calibration takes them, in the frame that they were
/// measured in: the mean over its steady window, or over all of it where its cables are still, as
/// one frame; of a moving one up to `most_frames`, spread over its time, with the markers of that
/// moment. Their covariances are of markers_sigma_m (or what the still ones vary by, where that is
/// more) over the number averaged, and `marker_bias_m` squared.
/// Throws InputError (file:line) as ObserveRecording does.
std::vector<CalibrationFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                                const experiment::Recording& recording,
                                                const robot::RobotModel& model,
                                                robot::CableInput preferred, double marker_bias_m,
                                                int most_frames = 6);

/// The same in the robot's frame, of a recording of which it is known where the camera stood. Its
/// reference window is a frame of its own, of the undeformed body without weight, or of the body at
/// rest without loads; `marker_bias_m`, an error between the two, counts in the others alone.
std::vector<CalibrationFrame> RobotFramesOfRecording(const experiment::Experiment& experiment,
                                                     const experiment::Recording& recording,
                                                     const robot::RobotModel& model,
                                                     robot::CableInput preferred,
                                                     double marker_bias_m, int most_frames = 6);

}  // namespace palpate::calibration
