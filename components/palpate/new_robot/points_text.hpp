// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::command {

/// "x,y,z;x,y,z;..." as columns. Throws InputError beginning with `what`.
Eigen::Matrix3Xd ParsePoints(std::string_view text, const std::string& what);

/// One "x,y,z". Throws InputError beginning with `what`.
Eigen::Vector3d ParsePoint(std::string_view text, const std::string& what);

/// "(12, 0, 110) mm" of a point in m.
std::string PointText_mm(const Eigen::Vector3d& point_m);

/// The pieces of a text between separators.
std::vector<std::string> SplitText(std::string_view text, char separator);

}  // namespace palpate::command
