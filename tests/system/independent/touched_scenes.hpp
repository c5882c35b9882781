// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/system/independent/calculix_body.hpp"
#include "tests/system/independent/ray_caster.hpp"

namespace palpate::test_support {

/// Static scenes to be made. Each is one recording.
struct TouchedScenesPlan {
  std::string robot = "four_leg";  ///< or "rod": of config/robots
  int postures = 6;                ///< contact-free recordings; the first at rest
  int single = 22;                 ///< one ball that the camera sees
  int pairs = 8;                   ///< two of them
  int hidden = 4;                  ///< one ball on a side that the camera does not see
  int weights = 6;                 ///< lying on the tip
  int alone = 4;                   ///< nothing touches, of kind free
  int frames = 4;                  ///< of a recording
  double largest_tension_N = 1.5;  ///< of the cables of a posture
  std::uint64_t seed = 1;
  PinholeCamera camera = {};  ///< the pose is the robot's own
  DepthErrors errors = {};
  /// Error of T_robot_camera in experiment.yaml.
  Eigen::Vector3d pose_error_m = {0.001, -0.0012, 0.0012};
  Eigen::Vector3d pose_error_rad = {0.003, -0.002, 0.004};
};

/// A contact that is there.
struct TrueContact {
  std::string recording;
  std::string group;  ///< single, pair, hidden, weight
  Eigen::Vector3d position_m;
  Eigen::Vector3d force_N;
};

/// Writes the experiment folder: shapes from CalculiX, images from RayCaster. Only the robot file
/// and the format of the folder are palpate's. Throws std::runtime_error.
std::vector<TrueContact> WriteTouchedScenes(const TouchedScenesPlan& plan,
                                            const std::filesystem::path& folder);

}  // namespace palpate::test_support
