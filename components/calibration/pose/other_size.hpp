// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "components/calibration/pose/marker_assignment.hpp"
#include "components/calibration/size_comparison.hpp"

namespace palpate::calibration {

/// For points without an assignment: whether they are markers of a robot of another size (0.6
/// to 1.7 times), with both sizes. nullopt: no such size.
std::optional<SizeComparison> FindOtherSize(const MarkerShapes& shapes,
                                            const Eigen::Matrix3Xd& points_m,
                                            const AssignmentSettings& settings);

}  // namespace palpate::calibration
