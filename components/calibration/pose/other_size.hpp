// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "components/calibration/pose/marker_assignment.hpp"
#include "components/calibration/size_comparison.hpp"

namespace palpate::calibration {

/// For points that AssignMarkers cannot make the robot's markers: whether they could be those of a
/// robot of another size (0.6 to 1.7 times), and how large both are. nullopt: of none of these.
std::optional<SizeComparison> FindOtherSize(const MarkerShapes& shapes,
                                            const Eigen::Matrix3Xd& points_m,
                                            const AssignmentSettings& settings);

}  // namespace palpate::calibration
