// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/surface_matching.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "components/force_estimation/shape/point_matching.hpp"
#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/correspondence/moving_surface.hpp"
#include "libs/correspondence/patch_matching.hpp"
#include "libs/correspondence/predicted_view.hpp"

namespace palpate::force_estimation {

namespace {

void CheckInput(const ShapeFrame& frame, const Eigen::VectorXd& x_m, int last_node) {
  for (const auto& [cloud, T_robot_camera, texture] : frame.views) {
    PALPATE_CHECK(cloud.sigma_m.size() == cloud.Count(), cloud.sigma_m.size(), cloud.Count());
    PALPATE_CHECK(cloud.points_m.allFinite());
    PALPATE_CHECK(cloud.Count() == 0 ||
                  (cloud.sigma_m.allFinite() && cloud.sigma_m.minCoeff() > 0));
    PALPATE_CHECK(T_robot_camera.matrix().allFinite());
  }
  PALPATE_CHECK(x_m.size() > 3 * last_node + 2 && x_m.allFinite(), x_m.size(), last_node);
}

/// Median distance to the nearest neighbour of `most_samples` points spread over the cloud, m.
double Spacing_m(const Eigen::Matrix3Xf& points_m, Eigen::Index most_samples) {
  if (points_m.cols() < 2) return 0.0;
  const Eigen::Index samples = std::min(most_samples, points_m.cols());
  std::vector<float> squared_m2;
  for (Eigen::Index s = 0; s < samples; ++s) {
    const Eigen::Index k = s * points_m.cols() / samples;
    float least_m2 = std::numeric_limits<float>::infinity();
    for (Eigen::Index other = 0; other < points_m.cols(); ++other) {
      if (other == k) continue;
      const float here_m2 = (points_m.col(other) - points_m.col(k)).squaredNorm();
      if (here_m2 < least_m2) least_m2 = here_m2;
    }
    squared_m2.push_back(least_m2);
  }
  return std::sqrt(static_cast<double>(UpperMedian(squared_m2)));
}

correspondence::MatchDistances ChooseDistances(const ShapeConfig& config,
                                               const rgbd::SensedCloud& cloud,
                                               const SurfaceMatchingTuning& tuning) {
  correspondence::MatchDistances distances{config.hidden_distance_m, config.outlier_distance_m};
  if (distances.hidden_m == 0.0) {
    distances.hidden_m = 2.0 * Spacing_m(cloud.points_m, tuning.spacing_samples);
  }
  if (distances.outlier_m == 0.0) {
    std::vector<float> sigmas_m(cloud.sigma_m.data(), cloud.sigma_m.data() + cloud.sigma_m.size());
    distances.outlier_m = tuning.motion_m + 3.0 * static_cast<double>(UpperMedian(sigmas_m));
  }
  return distances;
}

/// For a patch, whose points are not searched along the surface point's normal line.
void MeasureLineDistances(const correspondence::SurfaceFeatures& features,
                          const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                          std::span<correspondence::FeatureMatch> matches) {
  const Eigen::Matrix3Xd normals = features.Normals(x_m);
  for (int feature = 0; feature < features.Count(); ++feature) {
    correspondence::FeatureMatch& match = matches[At(feature)];
    if (match.state != correspondence::MatchState::kMatched) continue;
    const Eigen::Vector3d offset_m =
        T_robot_camera * match.position_m - features.point(feature).Position(x_m);
    match.line_distance_m = offset_m.cross(normals.col(feature)).norm();
  }
}

}  // namespace

struct SurfaceMatching::Parts {
  const correspondence::SurfaceFeatures& features;
  ShapeConfig config;
  SurfaceMatchingTuning tuning;
  correspondence::MovingSurface surface;
  correspondence::PredictedView view;
  correspondence::PatchMatching patches;
  std::vector<correspondence::FeatureMatch> matches;

  void MatchView(const ShapeView& seen, const Eigen::VectorXd& x_m,
                 std::span<correspondence::FeatureMatch> of_camera);
};

SurfaceMatching::SurfaceMatching(const correspondence::SurfaceFeatures& features,
                                 const ShapeConfig& config, const SurfaceMatchingTuning& tuning)
    : parts_(new Parts{features,
                       config,
                       tuning,
                       correspondence::MovingSurface(features.triangles()),
                       correspondence::PredictedView(),
                       correspondence::PatchMatching(features),
                       {}}) {}

SurfaceMatching::~SurfaceMatching() = default;

const std::vector<correspondence::FeatureMatch>& SurfaceMatching::Match(
    const ShapeFrame& frame, const Eigen::VectorXd& x_m) {
  const correspondence::SurfaceFeatures& features = parts_->features;
  std::vector<correspondence::FeatureMatch>& matches = parts_->matches;
  CheckInput(frame, x_m, features.triangles().maxCoeff());
  const auto count = static_cast<std::size_t>(features.Count());
  matches.assign(frame.views.size() * count, correspondence::FeatureMatch{});
  for (std::size_t camera = 0; camera < frame.views.size(); ++camera) {
    const std::span of_camera = std::span(matches).subspan(camera * count, count);
    for (std::size_t feature = 0; feature < count; ++feature) {
      of_camera[feature].feature = static_cast<int>(feature);
      of_camera[feature].camera = static_cast<int>(camera);
    }
    parts_->MatchView(frame.views[camera], x_m, of_camera);
  }
  return matches;
}

void SurfaceMatching::Parts::MatchView(const ShapeView& seen, const Eigen::VectorXd& x_m,
                                       std::span<correspondence::FeatureMatch> of_camera) {
  const auto& [cloud, T_robot_camera, texture] = seen;
  if (cloud.Count() == 0) return;
  const correspondence::MatchDistances distances = ChooseDistances(config, cloud, tuning);
  surface.MoveTo(x_m, T_robot_camera.inverse());
  view.Look(surface.vertices_m(), surface.triangles());
  if (config.matching == "point") {
    MatchPoints(features, cloud, T_robot_camera, x_m, view, distances, of_camera, tuning);
  } else {
    patches.Match(cloud, T_robot_camera, surface, view, distances, of_camera);
    MeasureLineDistances(features, T_robot_camera, x_m, of_camera);
  }
}

}  // namespace palpate::force_estimation
