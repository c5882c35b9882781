// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The number of this name that a calibration looked for; nullptr: it did not.
const FittedValue* FindValue(const JointCalibration& fit, const std::string& name);

/// Two determined numbers whose errors go together: the data tell less of each than of both.
struct CorrelatedValues {
  std::string one;
  std::string other;
  double correlation = 0.0;
};
/// Those with a correlation of at least so much in size, the closest ones first.
std::vector<CorrelatedValues> FindCorrelated(const JointCalibration& fit, double least);

/// Names of the materials (RobotBody::materials) in calibration files: "body", then the regions'.
std::vector<std::string> PartNames(const robot::RobotBody& body);

/// Puts into the file what a joint calibration that succeeded found: the pose, drives, materials,
/// gravity, size and cables' paths that its data determine, the names of what they do not, and how
/// well it fits. Marker offsets are no part of a calibration file. `model`'s gravity is the nominal
/// one.
void TakeFit(const JointCalibration& fit, const robot::RobotModel& model,
             robot::CalibrationFile* file);

/// Puts the depth bias that was found from images of this size and lens into the file, with the
/// pose, which it belongs to.
void TakeDepthBias(const JointCalibration& fit, const geometry::DepthPicture& picture,
                   robot::CalibrationFile* file);

}  // namespace palpate::calibration
