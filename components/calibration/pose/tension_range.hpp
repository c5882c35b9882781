// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Largest tension of each cable in these frames, `most_N` [a] > 0: that of their inputs with
/// actuators off by two `actuator_offset_sigma_m`, and a fifth more. For a cable without an input
/// in some frame: the tension at which a marker has moved by a quarter of the markers' RMS distance
/// from their centroid, at most max_tension_N. Fails where the model has no equilibrium under a
/// frame's inputs. The model is unchanged.
Status FindTensionRange(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                        double actuator_offset_sigma_m, Eigen::VectorXd* most_N);

}  // namespace palpate::calibration
