// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The markers of a recording for a joint calibration, in the measurement frame. A recording with a
/// steady window, or with still cables, gives one frame: the mean over it. A moving one gives up to
/// `most_frames` single times, spread over the recording. Covariances are the noise variance
/// (measured, at least markers_sigma_m) over the number averaged, plus `marker_bias_m` squared.
/// Throws InputError (file:line) as ObserveRecording does.
std::vector<CalibrationFrame> FramesOfRecording(const experiment::Experiment& experiment,
                                                const experiment::Recording& recording,
                                                const robot::RobotModel& model,
                                                robot::CableInput preferred, double marker_bias_m,
                                                int most_frames = 6);

/// The same in the robot frame, for a recording with a known camera pose. Its reference window is a
/// further frame: the undeformed body without weight, or the equilibrium without loads.
/// `marker_bias_m` is an error between both and counts in the other frames only.
std::vector<CalibrationFrame> RobotFramesOfRecording(const experiment::Experiment& experiment,
                                                     const experiment::Recording& recording,
                                                     const robot::RobotModel& model,
                                                     robot::CableInput preferred,
                                                     double marker_bias_m, int most_frames = 6);

}  // namespace palpate::calibration
