// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"

namespace palpate::geometry {

/// The keys of a pose in a file.
const KeyTable& PoseKeys();

/// `{translation_m: [x, y, z], rotation_xyzw: {x, y, z, w}}`; the rotation may also be a list
/// [x, y, z, w]. Throws InputError where its norm is off 1 by more than 1e-3; normalises.
Eigen::Isometry3d ReadPose(const ConfigNode& node);

/// What ReadPose reads back (the rotation to the last bit or two).
std::string FormatPose(const Eigen::Isometry3d& pose);
std::string FormatVector(const Eigen::VectorXd& vector);  ///< "[x, y, z]"

}  // namespace palpate::geometry
