// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/large_planes.hpp"

#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace palpate::perception {

namespace {

float Extent_m(const Eigen::Matrix3Xf& points_m, const pcl::Indices& chosen) {
  const Eigen::Matrix3Xf of_plane_m = points_m(Eigen::all, chosen);
  return (of_plane_m.rowwise().maxCoeff() - of_plane_m.rowwise().minCoeff()).norm();
}

double RmsDistance_m(const Eigen::Matrix3Xf& points_m, const pcl::Indices& chosen,
                     const Eigen::Vector4f& plane) {
  const Eigen::Matrix3Xf of_plane_m = points_m(Eigen::all, chosen);
  const Eigen::RowVectorXf off_m = (plane.head<3>().transpose() * of_plane_m).array() + plane[3];
  return std::sqrt(static_cast<double>(off_m.squaredNorm()) / static_cast<double>(off_m.size()));
}

bool IsLargeAndFlat(const Eigen::Matrix3Xf& points_m, const pcl::Indices& chosen,
                    const Eigen::Vector4f& plane, const ColorConfig& config,
                    const LargePlanesTuning& tuning) {
  return static_cast<double>(Extent_m(points_m, chosen)) >= config.background_extent_m &&
         RmsDistance_m(points_m, chosen, plane) <=
             tuning.flat_thicknesses * config.background_thickness_m;
}

}  // namespace

std::vector<Eigen::Vector4f> FindLargePlanes(const Eigen::Matrix3Xf& points_m,
                                             const ColorConfig& config,
                                             const LargePlanesTuning& tuning) {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  const Cloud::Ptr cloud(new Cloud);
  for (const auto point_m : points_m.colwise()) {
    cloud->push_back({point_m.x(), point_m.y(), point_m.z()});
  }
  pcl::SACSegmentation<pcl::PointXYZ> ransac;  // begins with the same random numbers each time
  ransac.setModelType(pcl::SACMODEL_PLANE);
  ransac.setMethodType(pcl::SAC_RANSAC);
  ransac.setMaxIterations(tuning.ransac_iterations);
  ransac.setDistanceThreshold(config.background_thickness_m);
  ransac.setOptimizeCoefficients(true);
  ransac.setInputCloud(cloud);
  const pcl::IndicesPtr left(new pcl::Indices(cloud->size()));
  std::iota(left->begin(), left->end(), 0);
  const double fewest = std::max(3.0, tuning.least_share * static_cast<double>(cloud->size()));
  std::vector<Eigen::Vector4f> planes;
  for (int tries = 0; tries < tuning.most_tries && planes.size() < tuning.most_planes &&
                      static_cast<double>(left->size()) >= fewest;
       ++tries) {
    pcl::PointIndices on_plane;
    pcl::ModelCoefficients plane;
    ransac.setIndices(left);
    ransac.segment(on_plane, plane);
    if (static_cast<double>(on_plane.indices.size()) < fewest) break;
    // A plane through several objects is none of them, but may be found before their own.
    const Eigen::Vector4f found(plane.values.data());
    if (IsLargeAndFlat(points_m, on_plane.indices, found, config, tuning)) planes.push_back(found);
    pcl::Indices rest;
    std::set_difference(left->begin(), left->end(), on_plane.indices.begin(),
                        on_plane.indices.end(), std::back_inserter(rest));
    *left = std::move(rest);
  }
  return planes;
}

}  // namespace palpate::perception
