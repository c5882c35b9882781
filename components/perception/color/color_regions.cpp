// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/color_regions.hpp"

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/region_growing_rgb.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "components/perception/contacts/point_grid.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

namespace {

using Point = pcl::PointXYZRGB;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr ToPcl(const VoxelCloud& cloud) {
  const Cloud::Ptr points(new Cloud);
  points->reserve(static_cast<std::size_t>(cloud.Count()));
  for (int i = 0; i < cloud.Count(); ++i) {
    const std::uint8_t* rgb = cloud.colors_rgb.data() + 3 * ToIndex(i);
    Point point(rgb[0], rgb[1], rgb[2]);
    point.getVector3fMap() = cloud.points_m.col(i);
    points->push_back(point);
  }
  return points;
}

using Region = std::vector<int>;

Eigen::Vector3d MeanColor(const VoxelCloud& cloud, const Region& region) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int point : region) sum += cloud.Color(point);
  return sum / static_cast<double>(region.size());
}

/// Joins regions that are too small with others. PCL itself joins them with the nearest one,
/// however far away and of whatever colour.
class SmallRegions {
 public:
  SmallRegions(const VoxelCloud& cloud, const ColorConfig& config)
      : cloud_(cloud),
        config_(config),
        reach_m_(static_cast<float>(config.region_distance_voxels * cloud.voxel_m)) {
    grid_.Build(cloud.points_m, reach_m_);
  }

  /// The regions that are large enough, with the small ones that are near and of their colour.
  std::vector<Region> Join(std::vector<Region> regions) const {
    const auto is_small = [this](const Region& region) {
      return region.size() < static_cast<std::size_t>(config_.min_region_points);
    };
    std::vector<int> region_of_point(static_cast<std::size_t>(cloud_.Count()), kNoRegion);
    std::vector<Eigen::Vector3d> colors;
    for (std::size_t r = 0; r < regions.size(); ++r) {
      colors.push_back(MeanColor(cloud_, regions[r]));
      if (is_small(regions[r])) continue;
      for (const int point : regions[r]) region_of_point[At(point)] = static_cast<int>(r);
    }
    for (std::size_t r = 0; r < regions.size(); ++r) {
      if (!is_small(regions[r])) continue;
      const int other = FindPartner(regions[r], colors[r], region_of_point, colors);
      if (other == kNoRegion) continue;
      regions[At(other)].insert(regions[At(other)].end(), regions[r].begin(), regions[r].end());
    }
    std::erase_if(regions, is_small);
    return regions;
  }

 private:
  static constexpr int kNoRegion = -1;

  /// The nearest large region within both thresholds; kNoRegion: none.
  int FindPartner(const Region& region, const Eigen::Vector3d& color,
                  const std::vector<int>& region_of_point,
                  const std::vector<Eigen::Vector3d>& colors) const {
    int nearest = kNoRegion;
    float nearest_m2 = std::numeric_limits<float>::infinity();
    for (const int point : region) {
      grid_.ForEachNear(cloud_.points_m.col(point), reach_m_, [&](int other, float squared_m2) {
        const int r = region_of_point[At(other)];
        if (r != kNoRegion && squared_m2 < nearest_m2 &&
            (colors[At(r)] - color).norm() < config_.region_color_threshold) {
          nearest = r;
          nearest_m2 = squared_m2;
        }
        return true;
      });
    }
    return nearest;
  }

  const VoxelCloud& cloud_;
  const ColorConfig& config_;
  float reach_m_;
  PointGrid grid_;
};

}  // namespace

std::vector<std::vector<int>> GrowRegions(const VoxelCloud& cloud, const ColorConfig& config) {
  if (cloud.Count() == 0) return {};
  const Cloud::Ptr points = ToPcl(cloud);
  pcl::RegionGrowingRGB<Point> growing;
  growing.setInputCloud(points);
  growing.setSearchMethod(pcl::search::KdTree<Point>::Ptr(new pcl::search::KdTree<Point>));
  growing.setDistanceThreshold(static_cast<float>(config.region_distance_voxels * cloud.voxel_m));
  growing.setPointColorThreshold(static_cast<float>(config.point_color_threshold));
  growing.setRegionColorThreshold(static_cast<float>(config.region_color_threshold));
  growing.setMinClusterSize(1);  // else it joins small regions itself
  std::vector<pcl::PointIndices> grown;
  growing.extract(grown);
  std::vector<Region> regions;
  for (const pcl::PointIndices& region : grown) regions.push_back(region.indices);
  return SmallRegions(cloud, config).Join(std::move(regions));
}

}  // namespace palpate::perception
