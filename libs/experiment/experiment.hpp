// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::experiment {

struct DepthNoise {
  double subpixel_px = 0.0;  ///< >= 0
  double unit_m = 0.0;       ///< >= 0, one step of the depth value
};

/// A folder of measured data (format: docs/experiment.md): experiment.yaml and its recordings. One
/// clock for all of them; they were made in the order of their names.
struct Experiment {
  std::filesystem::path folder;
  std::optional<std::filesystem::path> robot;  ///< resolved against experiment.yaml
  MeasurementFrame frame = MeasurementFrame::kRobot;
  std::optional<Eigen::Isometry3d> T_robot_camera;  ///< p_robot = T_robot_camera * p_camera
  /// Of T_robot_camera; absent: not stated, see PoseErrorOf.
  std::optional<geometry::PoseStandardError> T_robot_camera_error;
  std::vector<CameraSettings> cameras;             ///< beside the first
  std::optional<Eigen::Vector3d> markers_sigma_m;  ///< > 0, for each axis of the measurement frame
  std::optional<DepthNoise> depth_noise;
  std::map<std::string, double> tolerances;  ///< cause id (or *_m, *_rad) -> tau > 0
  std::optional<double> rest_between_s;      ///< >= 0; absent: unknown
  std::string notes;
  /// `answer_sha256`: 64 hexadecimal digits, the seal of the answer file that belongs to a blind
  /// test
  /// (`palpate simulate`).
  std::optional<std::string> answer_sha256;
  std::vector<Recording> recordings;  ///< by name, at least one
};

/// Reads an experiment folder, or a single recording folder (then an experiment of that one
/// recording, with the settings of the experiment.yaml two folders up where there is one).
/// Throws InputError with file:line:column at the first thing that is wrong: unknown key (with "did
/// you mean"), NaN, unsorted time, a sample given twice, wrong units, ... Nothing is half-read.
Experiment ReadExperiment(const std::filesystem::path& folder, const ConfigLoader& load);

/// The keys of experiment.yaml.
const KeyTable& ExperimentKeys();

/// experiment.yaml alone; `recordings` stays empty.
Experiment ReadExperimentSettings(const std::filesystem::path& file, const ConfigLoader& load);

/// Writes the folder, created where absent; ReadExperiment reads the same back. Throws InputError
/// where it holds an experiment already, RunError where it cannot be written.
void WriteExperiment(const Experiment& experiment, const std::filesystem::path& folder);

/// experiment.yaml alone.
void WriteExperimentSettings(const Experiment& experiment, const std::filesystem::path& file);

/// The frame in which the recording was measured.
MeasurementFrame FrameOf(const Experiment& experiment, const Recording& recording);

/// Measured in the camera frame, and the camera pose is unknown.
struct NeedsCalibration {
  std::string reason;
};

/// T_robot_measurement, the map from the recording's measured coordinates to the robot frame:
/// identity for `frame: robot`; for `frame: camera` the recording's T_robot_camera, else the
/// experiment's (turned along where the base was tilted and the camera was not on the base). A
/// `camera_moved` recording without a pose of its own needs calibration; never identity instead.
std::variant<Eigen::Isometry3d, NeedsCalibration> RobotFromMarkers(const Experiment& experiment,
                                                                   const Recording& recording);

/// T_robot_camera of a recording's images, which are in the camera frame whatever the `frame` of
/// its markers is: as RobotFromMarkers finds it for `frame: camera`.
std::variant<Eigen::Isometry3d, NeedsCalibration> RobotFromCamera(const Experiment& experiment,
                                                                  const Recording& recording);

/// Standard error of the pose that these two functions give: that of the recording where it has a
/// pose of its own, else that of the experiment; where none is stated, PoseStandardError's
/// defaults.
geometry::PoseStandardError PoseErrorOf(const Experiment& experiment, const Recording& recording);

}  // namespace palpate::experiment
