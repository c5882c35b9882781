// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <vector>

#include "components/calibration/cloud/pose_search.hpp"
#include "components/calibration/size_comparison.hpp"

namespace palpate::calibration {

/// Requirements for another size.
struct SizeDemands {
  /// Smallest coverage of the visible surface. About half of it lies near any cloud of that extent,
  /// so that less is no evidence.
  double least_cover = 0.8;
  double most_rms_m = 0.003;  ///< largest RMS distance along the normal
};

/// For clouds that do not fit the robot: whether they fit one of the same shape and another size
/// (0.6 to 1.6 times, then refined), with both sizes. `surfaces`: those of the model at its own
/// size. nullopt: no size, or that of the model.
std::optional<SizeComparison> FindOtherSize(std::vector<SurfaceInView>& surfaces,
                                            const std::vector<ThinCloud>& clouds,
                                            const geometry::RigidTransform& T_robot_camera_start,
                                            const PoseSearchSettings& settings,
                                            const SizeDemands& demands);

}  // namespace palpate::calibration
