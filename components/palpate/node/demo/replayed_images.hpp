// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <filesystem>

namespace palpate::command {

/// Recordings with images that the processes can take for one run of a camera.
struct ReplayedImages {
  int recordings = 0;
  int frames = 0;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< of all of them
};

/// What `data`, an experiment or one recording, holds of them. Throws InputError where there are
/// none, where nobody says where the camera was, and where it was moved between two of them.
ReplayedImages ExamineImages(const std::filesystem::path& data);

}  // namespace palpate::command
