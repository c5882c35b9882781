// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"

namespace palpate::geometry {

/// The keys of a pose in a file.
const KeyTable& PoseKeys();

/// `{translation_m: [x, y, z], rotation_xyzw: {x, y, z, w}}`; the rotation may also be a list
/// [x, y, z, w]. Throws InputError where its norm is off 1 by more than 1e-3; normalises.
Eigen::Isometry3d ReadPose(const ConfigNode& node);

/// Standard errors of a measured pose T_target_source, along and about each axis of the target
/// frame. The defaults are those of a pose whose error nobody has stated: a pose is never exact.
struct PoseStandardError {
  double translation_m = 0.005;  ///< > 0, of the source's origin
  double rotation_rad = 0.01;    ///< > 0, about the source's origin
};

/// The keys of a pose and of its `standard_error`.
const KeyTable& MeasuredPoseKeys();

/// ReadPose of a pose that may carry `standard_error: {translation_m, rotation_rad}`; nullopt: it
/// does not.
Eigen::Isometry3d ReadMeasuredPose(const ConfigNode& node,
                                   std::optional<PoseStandardError>* standard_error);

/// What ReadPose, or ReadMeasuredPose, reads back (the rotation to the last bit or two).
std::string FormatPose(const Eigen::Isometry3d& pose,
                       const std::optional<PoseStandardError>& standard_error = std::nullopt);
std::string FormatVector(const Eigen::VectorXd& vector);  ///< "[x, y, z]"

}  // namespace palpate::geometry
