// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/inference/hypothesis_set.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::diagnosis {

/// Which values of the robot file, or of the actuators of a calibration, a fault with its
/// parameters at `z` changes, with the intervals that follow from `covariance` to first order.
/// Empty: these files cannot hold the fault.
std::vector<ChangedValue> ChangesInFiles(const FaultModel& fault, const Eigen::VectorXd& z,
                                         const Eigen::MatrixXd& covariance,
                                         const robot::RobotDescription& robot);

}  // namespace palpate::diagnosis
