// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/color_regions.hpp"

#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/region_growing_rgb.h>

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
  growing.setMinClusterSize(config.min_region_points);
  std::vector<pcl::PointIndices> grown;
  growing.extract(grown);
  std::vector<std::vector<int>> regions;
  for (const pcl::PointIndices& region : grown) regions.push_back(region.indices);
  return regions;
}

}  // namespace palpate::perception
