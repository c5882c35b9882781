// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

namespace palpate::command {

/// Recordings with images of one camera pose.
struct ReplayedImages {
  int recordings = 0;
  int frames = 0;
  int fewest_frames = 0;                                             ///< of a recording
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< of all of them
};

/// Those of `data`, an experiment or one recording. `calibrated`: the camera pose of a calibration
/// file, which goes before the experiment's. Throws InputError where there are none, where a camera
/// pose is missing, and where it differs between two of them.
ReplayedImages ExamineImages(const std::filesystem::path& data,
                             const std::optional<Eigen::Isometry3d>& calibrated);

}  // namespace palpate::command
