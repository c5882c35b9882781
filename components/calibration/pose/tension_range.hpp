// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Up to which tension each cable may be pulled in these frames, `most_N` [a] > 0: what their
/// inputs ask for, drives off by two `drive_offset_sigma_m`, and a fifth more. Of a cable of which
/// nothing is known in some frame: as far as no marker moves by more than a quarter of the RMS
/// distance of the markers from their middle, and not above the robot file's max_tension_N. Fails
/// where the model has no equilibrium under a frame's inputs. The model is left as it was.
Status FindTensionRange(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                        double drive_offset_sigma_m, Eigen::VectorXd* most_N);

}  // namespace palpate::calibration
