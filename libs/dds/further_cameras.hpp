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

}  // namespace palpate::dds
