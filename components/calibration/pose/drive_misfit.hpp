// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

struct DriveErrors {
  double displacement_m = 1e-3;  ///< of what the markers say of a cable's displacement, one sigma
  double offset_m = 2e-3;        ///< of a drive's zero, the same in all frames
};

/// Which displacement each cable has in each frame under its input, [a x frames] m; NaN where
/// nothing is known of the input, or the model has no equilibrium under it.
Eigen::MatrixXd CommandedDisplacements_m(robot::RobotModel& model,
                                         const std::vector<CalibrationFrame>& frames);

/// How far the drives contradict tensions that were read off the markers, `tension_N` [frames][a]:
/// sum of squares over `errors` of the cables' displacements under these tensions less
/// `commanded_m` [a x frames], the zeros of the drives chosen best. NaN entries are passed over.
/// The model is left as it was.
double DriveMisfit(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                   const std::vector<Eigen::VectorXd>& tension_N,
                   const Eigen::MatrixXd& commanded_m, const DriveErrors& errors);

}  // namespace palpate::calibration
