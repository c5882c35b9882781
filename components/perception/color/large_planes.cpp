// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/color/large_planes.hpp"

#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace palpate::perception {

namespace {

using PlainCloud = pcl::PointCloud<pcl::PointXYZ>;

struct FittedPlane {
  Eigen::Vector4f plane;  ///< n, d with n . x + d = 0; |n| = 1
  pcl::Indices on_plane;  ///< points within the thickness
};

/// The plane with the most of the points `left`, fitted to them. nullopt: none was found.
std::optional<FittedPlane> FitPlane(const PlainCloud::ConstPtr& cloud, const pcl::Indices& left,
                                    double thickness_m, int iterations) {
  // A new model begins with the same random numbers each time.
  const pcl::SampleConsensusModelPlane<pcl::PointXYZ>::Ptr model(
      new pcl::SampleConsensusModelPlane<pcl::PointXYZ>(cloud, left));
  pcl::RandomSampleConsensus<pcl::PointXYZ> ransac(model, thickness_m);
  ransac.setMaxIterations(iterations);
  if (!ransac.computeModel()) return std::nullopt;
  FittedPlane fitted;
  ransac.getInliers(fitted.on_plane);
  Eigen::VectorXf drawn, refined;
  ransac.getModelCoefficients(drawn);
  model->optimizeModelCoefficients(fitted.on_plane, drawn, refined);
  model->selectWithinDistance(refined, thickness_m, fitted.on_plane);
  fitted.plane = refined;
  return fitted;
}

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
  const PlainCloud::Ptr cloud(new PlainCloud);
  for (const auto point_m : points_m.colwise()) {
    cloud->push_back({point_m.x(), point_m.y(), point_m.z()});
  }
  pcl::Indices left(cloud->size());
  std::iota(left.begin(), left.end(), 0);
  const double fewest = std::max(3.0, tuning.least_share * static_cast<double>(cloud->size()));
  std::vector<Eigen::Vector4f> planes;
  for (int tries = 0; tries < tuning.most_tries && planes.size() < tuning.most_planes &&
                      static_cast<double>(left.size()) >= fewest;
       ++tries) {
    const std::optional<FittedPlane> fitted =
        FitPlane(cloud, left, config.background_thickness_m, tuning.ransac_iterations);
    if (!fitted || static_cast<double>(fitted->on_plane.size()) < fewest) break;
    // A plane through several objects is none of them, but may be found before their own.
    if (IsLargeAndFlat(points_m, fitted->on_plane, fitted->plane, config, tuning)) {
      planes.push_back(fitted->plane);
    }
    pcl::Indices rest;
    std::set_difference(left.begin(), left.end(), fitted->on_plane.begin(), fitted->on_plane.end(),
                        std::back_inserter(rest));
    left = std::move(rest);
  }
  return planes;
}

}  // namespace palpate::perception
