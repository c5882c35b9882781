// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/perception/color/voxel_cloud.hpp"

namespace palpate::perception {

/// Colour-based region growing (Zhan, Liang and Xiao 2009), by PCL: the points of each region.
/// Points in none were in too small a region, with no large one within both thresholds.
std::vector<std::vector<int>> GrowRegions(const VoxelCloud& cloud, const ColorConfig& config);

}  // namespace palpate::perception
