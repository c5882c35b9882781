// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <vector>

#include "components/calibration/cloud/pose_search.hpp"
#include "components/calibration/size_comparison.hpp"

namespace palpate::calibration {

/// What a size must explain.
struct SizeDemands {
  /// Share of the skin that should be seen and has points near it; of less a size says little: some
  /// half of it lies near any cloud of that extent.
  double least_cover = 0.8;
  double most_rms_m = 0.003;  ///< of points that lie on the skin, along its normal
};

/// For clouds that are not those of the robot: whether they are those of one of the same shape but
/// of another size (0.6 to 1.6 times, and what a fit adds), and how large both are. `skins`: the
/// model's, as large as its file says. nullopt also where the size is the model's.
std::optional<SizeComparison> FindOtherSize(std::vector<SkinInView>& skins,
                                            const std::vector<ThinCloud>& clouds,
                                            const geometry::RigidTransform& T_robot_camera_start,
                                            const PoseSearchSettings& settings,
                                            const SizeDemands& demands);

}  // namespace palpate::calibration
