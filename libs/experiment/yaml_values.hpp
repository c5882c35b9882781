// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "libs/core/config_node.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::experiment {

/// `{translation_m: [x, y, z], rotation_xyzw: {x, y, z, w}}`; the rotation may also be a list
/// [x, y, z, w]. Throws InputError where its norm is off 1 by more than 1e-3; normalises.
Eigen::Isometry3d ReadPose(const ConfigNode& node);

/// `[t0, t1]`, s, t0 < t1.
TimeWindow ReadWindow(const ConfigNode& node);

/// What the readers above, and YAML, read back exactly.
std::string FormatPose(const Eigen::Isometry3d& pose);
std::string FormatWindow(const TimeWindow& window);
std::string FormatVector(const Eigen::VectorXd& vector);  ///< "[x, y, z]"
std::string QuoteText(const std::string& text);           ///< double-quoted, escaped

}  // namespace palpate::experiment
