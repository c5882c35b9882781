// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/voxel_cloud.hpp"

#include <pcl/filters/passthrough.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "components/perception/noise_law.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::perception {

namespace {

using Point = pcl::PointXYZRGB;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr Unproject(const RegisteredFrame& frame, const Registration& registration,
                     Rejections* rejected) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  const int width = frame.z_m.width_px;
  const int height = frame.z_m.height_px;
  const Cloud::Ptr cloud(new Cloud(static_cast<std::uint32_t>(width),
                                   static_cast<std::uint32_t>(height),
                                   Point(kNothing, kNothing, kNothing)));
  cloud->is_dense = false;
  std::size_t pixel = 0;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u, ++pixel) {
      const float z_m = frame.z_m.values[pixel];
      const Eigen::Vector3f ray = registration.Ray(u, v);
      if (!std::isfinite(z_m) || !ray.allFinite()) {
        ++rejected->invalid_depth;
        continue;
      }
      if (frame.color_known[pixel] == 0) {
        ++rejected->ambiguous;
        continue;
      }
      Point& point = cloud->points[pixel];
      point.getVector3fMap() = z_m * ray;
      const std::uint8_t* rgb = frame.color.Pixel(u, v);
      point.r = rgb[0];
      point.g = rgb[1];
      point.b = rgb[2];
    }
  }
  return cloud;
}

Cloud::Ptr PassThrough(Cloud::Ptr cloud, const geometry::Box& box) {
  // z first: it removes most points.
  for (const auto& [name, axis] : {std::pair("z", 2), std::pair("x", 0), std::pair("y", 1)}) {
    pcl::PassThrough<Point> filter;
    filter.setInputCloud(cloud);
    filter.setFilterFieldName(name);
    filter.setFilterLimits(static_cast<float>(box.lower_m[axis]),
                           static_cast<float>(box.upper_m[axis]));
    const Cloud::Ptr passed(new Cloud);
    filter.filter(*passed);
    cloud = passed;
  }
  return cloud;
}

/// In the order in which VoxelGrid writes its voxels: by z, then y, then x.
std::vector<int> CountInVoxels(const Cloud& cloud, float voxel_m) {
  using Voxel = std::array<int, 3>;
  std::vector<Voxel> voxels;
  voxels.reserve(cloud.size());
  const float per_voxel = 1.0f / voxel_m;
  for (const Point& point : cloud) {
    voxels.push_back({static_cast<int>(std::floor(point.z * per_voxel)),
                      static_cast<int>(std::floor(point.y * per_voxel)),
                      static_cast<int>(std::floor(point.x * per_voxel))});
  }
  std::sort(voxels.begin(), voxels.end());
  std::vector<int> counts;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (i == 0 || voxels[i] != voxels[i - 1]) counts.push_back(0);
    ++counts.back();
  }
  return counts;
}

/// VoxelGrid counts its voxels in 32 bits.
double SmallestVoxel_m(const Cloud& cloud) {
  constexpr double kMostVoxels = 1e9;
  Eigen::Array3f lower_m = cloud.front().getArray3fMap();
  Eigen::Array3f upper_m = lower_m;
  for (const Point& point : cloud) {
    lower_m = lower_m.min(point.getArray3fMap());
    upper_m = upper_m.max(point.getArray3fMap());
  }
  const Eigen::Array3d size_m = (upper_m - lower_m).cast<double>().max(1e-3);
  return std::cbrt(size_m.prod() / kMostVoxels);
}

double PixelPitch_m(const Cloud& cloud, double focal_px) {
  std::vector<float> z_m;
  z_m.reserve(cloud.size());
  for (const Point& point : cloud) z_m.push_back(point.z);
  return static_cast<double>(UpperMedian(z_m)) / focal_px;
}

/// The voxels, and the edge that it took.
Cloud::Ptr Downsample(const Cloud::Ptr& cloud, int most_points, double* voxel_m) {
  const Cloud::Ptr voxels(new Cloud);
  while (true) {
    const auto edge_m = static_cast<float>(*voxel_m);
    pcl::VoxelGrid<Point> filter;
    filter.setInputCloud(cloud);
    filter.setLeafSize(edge_m, edge_m, edge_m);
    filter.filter(*voxels);
    const double over = static_cast<double>(voxels->size()) / most_points;
    if (over <= 1.0) return voxels;
    *voxel_m *= std::max(1.05, std::sqrt(over));  // a surface has edge^-2 of them
  }
}

/// Without table and walls, which are searched in a coarser cloud. Far away the noise exceeds their
/// thickness.
Cloud::Ptr WithoutPlanes(const Cloud::Ptr& cloud, const Config& config, const NoiseLaw& noise,
                         const VoxelCloudTuning& tuning) {
  double voxel_m = std::max(config.color.background_thickness_m, SmallestVoxel_m(*cloud));
  const Cloud::Ptr coarse = Downsample(cloud, config.max_cloud_points, &voxel_m);
  Eigen::Matrix3Xf points_m(3, ToIndex(coarse->size()));
  for (std::size_t i = 0; i < coarse->size(); ++i) {
    points_m.col(ToIndex(i)) = (*coarse)[i].getVector3fMap();
  }
  const std::vector<Eigen::Vector4f> planes =
      FindLargePlanes(points_m, config.color, tuning.planes);
  const auto thickness_m = static_cast<float>(config.color.background_thickness_m);
  const Cloud::Ptr rest(new Cloud);
  std::copy_if(cloud->begin(), cloud->end(), std::back_inserter(*rest), [&](const Point& point) {
    return std::none_of(planes.begin(), planes.end(), [&](const Eigen::Vector4f& plane) {
      const float off_m = plane.head<3>().dot(point.getVector3fMap()) + plane[3];
      return std::abs(off_m) <= std::max(thickness_m, tuning.noise_sigmas * noise.At(point.z));
    });
  });
  return rest;
}

pcl::Indices WithNeighbours(const Cloud::Ptr& voxels, double radius_m, int neighbours) {
  pcl::Indices kept(voxels->size());
  std::iota(kept.begin(), kept.end(), 0);
  if (neighbours == 0) return kept;
  pcl::RadiusOutlierRemoval<Point> filter;
  filter.setInputCloud(voxels);
  filter.setRadiusSearch(radius_m);
  filter.setMinNeighborsInRadius(neighbours);
  filter.filter(kept);
  return kept;
}

VoxelCloud Take(const Cloud& voxels, const std::vector<int>& pixels, const pcl::Indices& kept) {
  VoxelCloud taken;
  taken.points_m.resize(3, ToIndex(kept.size()));
  for (const int i : kept) {
    const Point& point = voxels[At(i)];
    taken.points_m.col(taken.Count()) = point.getVector3fMap();
    taken.colors_rgb.insert(taken.colors_rgb.end(), {point.r, point.g, point.b});
    taken.pixels.push_back(pixels[At(i)]);
  }
  return taken;
}

}  // namespace

VoxelCloud FilterFrame(const RegisteredFrame& frame, const Registration& registration,
                       const geometry::Box& box, const Config& config, Rejections* rejected,
                       const VoxelCloudTuning& tuning) {
  const std::int64_t before = rejected->invalid_depth + rejected->ambiguous;
  const Cloud::Ptr whole = Unproject(frame, registration, rejected);
  const std::int64_t valid = static_cast<std::int64_t>(whole->size()) + before -
                             rejected->invalid_depth - rejected->ambiguous;
  Cloud::Ptr passed = PassThrough(whole, box);
  rejected->out_of_range += valid - static_cast<std::int64_t>(passed->size());
  if (passed->empty()) return {};
  passed = WithoutPlanes(passed, config, NoiseLaw(registration.camera(), NoiseOf(config)), tuning);
  if (passed->empty()) return {};
  double voxel_m = config.color.voxel_m > 0.0
                       ? config.color.voxel_m
                       : 2.0 * PixelPitch_m(*passed, registration.camera().depth.fx_px);
  voxel_m = std::max(voxel_m, SmallestVoxel_m(*passed));
  const Cloud::Ptr voxels = Downsample(passed, config.max_cloud_points, &voxel_m);
  const std::vector<int> pixels = CountInVoxels(*passed, static_cast<float>(voxel_m));
  PALPATE_CHECK(pixels.size() == voxels->size(), pixels.size(), voxels->size());
  const pcl::Indices kept = WithNeighbours(voxels, config.color.outlier_radius_voxels * voxel_m,
                                           config.color.outlier_neighbours);
  VoxelCloud cloud = Take(*voxels, pixels, kept);
  cloud.voxel_m = voxel_m;
  const std::int64_t left = std::accumulate(cloud.pixels.begin(), cloud.pixels.end(), 0);
  rejected->isolated += static_cast<std::int64_t>(passed->size()) - left;
  rejected->thinned += left - cloud.Count();
  return cloud;
}

}  // namespace palpate::perception
