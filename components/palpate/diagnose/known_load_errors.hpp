// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "libs/experiment/experiment.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

/// By recording and time: of each known load that acts, estimated - known along it, N.
using KnownLoadErrors = std::map<std::pair<std::string, double>, Eigen::VectorXd>;

/// Whether a recording has known loads, and markers or images that tell them.
bool HasMeasuredLoads(const experiment::Recording& recording);

/// Whether one estimation tells how far it is: of two at once one does.
enum class Progress { kReported, kSilent };

/// Errors of the forces that one robot feels at known loads, whose places are given, while it is to
/// be steady. From markers, where a recording has them, directions are given, too; else from
/// images. Frames in which a force is not observable are left out. Ends early where
/// `stop_requested`. Throws InputError for data that cannot be estimated from, and RunError for
/// images that do not fit the robot.
KnownLoadErrors EstimateKnownLoads(const robot::RobotDescription& robot,
                                   const std::optional<robot::CalibrationFile>& calibration,
                                   const experiment::Experiment& experiment, Progress progress,
                                   const std::function<bool()>& stop_requested);

}  // namespace palpate::command
