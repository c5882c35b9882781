// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/color_regions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace palpate::perception {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr double kVoxel_m = 0.002;

/// Points of a square grid of n x n voxels with its corner at x, all of one colour.
void AddPatch(VoxelCloud* cloud, int n, double x_m, const Eigen::Vector3i& rgb) {
  for (int i = 0; i < n * n; ++i) {
    cloud->points_m.conservativeResize(3, cloud->points_m.cols() + 1);
    cloud->points_m.rightCols<1>() =
        Eigen::Vector3d(x_m + kVoxel_m * (i % n), kVoxel_m * (i / n), 0.4).cast<float>();
    for (const int channel : rgb) cloud->colors_rgb.push_back(static_cast<std::uint8_t>(channel));
    cloud->pixels.push_back(1);
  }
}

/// A patch of 144 voxels that ends at x = 22 mm, and a small one of 9 behind a gap.
VoxelCloud TwoPatches(double gap_m, const Eigen::Vector3i& small_rgb) {
  VoxelCloud cloud;
  cloud.voxel_m = kVoxel_m;
  AddPatch(&cloud, 12, 0.0, {200, 60, 40});
  AddPatch(&cloud, 3, 11 * kVoxel_m + gap_m, small_rgb);
  return cloud;
}

std::vector<std::size_t> SizesOf(const std::vector<std::vector<int>>& regions) {
  std::vector<std::size_t> sizes;
  for (const auto& region : regions) sizes.push_back(region.size());
  return sizes;
}

TEST(GrowRegions, ASmallRegionNearbyOfTheColorJoins) {
  EXPECT_THAT(SizesOf(GrowRegions(TwoPatches(0.004, {204, 62, 40}), {})),
              testing::ElementsAre(153));
}

TEST(GrowRegions, ASmallRegionFarAwayIsDropped) {
  EXPECT_THAT(SizesOf(GrowRegions(TwoPatches(0.25, {200, 60, 40}), {})), testing::ElementsAre(144));
}

TEST(GrowRegions, ASmallRegionOfAnotherColorIsDropped) {
  EXPECT_THAT(SizesOf(GrowRegions(TwoPatches(0.004, {40, 60, 200}), {})),
              testing::ElementsAre(144));
  EXPECT_THAT(SizesOf(GrowRegions(TwoPatches(0.25, {40, 60, 200}), {})), testing::ElementsAre(144));
}

TEST(GrowRegions, NothingGivesNothing) {
  EXPECT_THAT(GrowRegions({}, {}), IsEmpty());
  VoxelCloud small;
  small.voxel_m = kVoxel_m;
  AddPatch(&small, 3, 0.0, {200, 60, 40});
  EXPECT_THAT(GrowRegions(small, {}), SizeIs(0));
}

}  // namespace
}  // namespace palpate::perception
