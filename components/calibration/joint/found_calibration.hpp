// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// The parameter of this name; nullptr: it was not estimated.
const FittedValue* FindValue(const JointCalibration& fit, const std::string& name);

/// Two determined parameters with correlated errors.
struct CorrelatedValues {
  std::string one;
  std::string other;
  double correlation = 0.0;
};
/// Pairs with a correlation of at least `least` in absolute value, the largest first.
std::vector<CorrelatedValues> FindCorrelated(const JointCalibration& fit, double least);

/// Names of the materials (RobotBody::materials) in calibration files: "body", then the regions'.
std::vector<std::string> PartNames(const robot::RobotBody& body);
/// Those of them that an element has: not the body where regions have all of its elements.
std::vector<std::string> PartsWithElements(const robot::RobotBody& body);

/// Those whose modulus is estimated where nothing else is asked for: the body, or all regions where
/// they have all of its elements.
std::vector<std::string> PartsToFit(const robot::RobotBody& body);

/// A calibration of this model from these recordings, dated now, without estimates.
robot::CalibrationFile MakeCalibration(const robot::RobotModel& model,
                                       const std::vector<const experiment::Recording*>& recordings,
                                       const std::filesystem::path& data);

/// Writes a successful joint calibration into `file`: pose, actuators, materials, gravity, size and
/// cable routes that the data determine, the names of undetermined parameters, and the residual.
/// Marker offsets are not part of a calibration file. `model` must have the nominal gravity.
void TakeFit(const JointCalibration& fit, const robot::RobotModel& model,
             robot::CalibrationFile* file);

/// Writes the depth bias of images of this size and lens into `file`, beside the pose that it
/// belongs to.
void TakeDepthBias(const JointCalibration& fit, const geometry::DepthPicture& picture,
                   robot::CalibrationFile* file);

/// What a calibration file says of a camera beside the first. `picture`: size and lens of its
/// images; nullopt: without depth bias.
robot::CalibratedCamera CameraOf(const std::string& name, const FittedCamera& fit,
                                 const std::optional<geometry::DepthPicture>& picture);

}  // namespace palpate::calibration
