// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

struct ActuatorErrors {
  double displacement_m = 1e-3;  ///< standard deviation of a displacement estimated from markers
  double offset_m = 2e-3;        ///< prior standard deviation of an actuator's offset, all frames
};

/// Displacement of each cable in each frame under its input, [a x frames] m; NaN without an input
/// or an equilibrium.
Eigen::MatrixXd CommandedDisplacements_m(robot::RobotModel& model,
                                         const std::vector<CalibrationFrame>& frames);

/// Chi-squared of the actuators against tensions estimated from markers, `tension_N` [frames][a]:
/// displacements under these tensions minus `commanded_m` [a x frames], with the offset of each
/// actuator marginalised. NaN entries are skipped. The model is unchanged.
double ActuatorMisfit(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                      const std::vector<Eigen::VectorXd>& tension_N,
                      const Eigen::MatrixXd& commanded_m, const ActuatorErrors& errors);

}  // namespace palpate::calibration
