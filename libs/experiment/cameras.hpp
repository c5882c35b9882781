// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::experiment {

// The first camera has no name, and its images lie in the recording itself. Further ones have a
// name and a folder each (docs/experiment.md).

/// The keys of an item of `cameras` in experiment.yaml and recording.yaml.
const KeyTable& CameraSettingsKeys();

/// The list `cameras`. Throws InputError at a name that is none, or is there twice.
std::vector<CameraSettings> ReadCameraSettings(const ConfigNode& list);
/// What ReadCameraSettings reads back, with the key; empty for none.
std::string FormatCameraSettings(const std::vector<CameraSettings>& cameras);

/// Letters, digits and underscores, of which a letter is first.
bool IsCameraName(const std::string& name);

/// Names of the cameras beside the first that have images in a recording, by name. The first
/// camera is number 0, these are 1, 2, ...
std::vector<std::string> FurtherCameras(const Experiment& experiment);

/// The experiment as this further camera alone recorded it: its images, lens, poses and, without
/// its clock offset, times. Markers, cables and loads are as before.
Experiment OfCamera(const Experiment& experiment, const std::string& name);
/// One recording of it; without images where the camera has none there.
Recording OfCamera(const Experiment& experiment, const Recording& recording,
                   const std::string& name);

/// Sets what `cameras` of experiment.yaml says of the pose of this further camera.
void SetPose(const std::string& name, const Eigen::Isometry3d& T_robot_camera,
             const geometry::PoseStandardError& error, Experiment* experiment);

}  // namespace palpate::experiment
