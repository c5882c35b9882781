// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::dds {

/// A depth camera beside the first.
struct FurtherCamera {
  std::string name;
  std::optional<Eigen::Isometry3d> T_robot_camera;  ///< nullopt: not given
};

/// The items of the setting `cameras`, by name: "NAME", or "NAME: {translation_m: [x, y, z],
/// rotation_xyzw: [x, y, z, w]}". `parse` reads a text of YAML, whose name is for messages. Throws
/// InputError for an item that is none of these, a name that is none (TopicsOf) or comes twice.
std::vector<FurtherCamera> ReadFurtherCameras(
    const std::vector<std::string>& items,
    const std::function<ConfigNode(const std::string& text, const std::string& name)>& parse);

/// Their names.
std::vector<std::string> NamesOf(const std::vector<FurtherCamera>& cameras);

/// Gives each camera without a pose that of its name in `calibrated`, the cameras of a calibration
/// file. Returns what a person should know: which of these do not run; empty: all do. Throws
/// InputError where a camera has no pose.
std::string TakePoses(const std::vector<FurtherCamera>& calibrated, const std::string& file,
                      std::vector<FurtherCamera>* cameras);

/// Names of further cameras that run, against those that a calibration holds.
struct CameraMatch {
  /// Run, and the calibration does not hold them: of cameras that were calibrated together none may
  /// move alone, so that no pose of it counts.
  std::vector<std::string> missing;
  std::vector<std::string> unknown;  ///< it holds them, and they do not run
};
CameraMatch MatchCameras(const std::vector<std::string>& running,
                         const std::vector<std::string>& calibrated);

/// What a person should know of it, as a sentence about the calibration; empty: all match.
std::string Describe(const CameraMatch& match);

}  // namespace palpate::dds
