// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/point_matching.hpp"

#include <cmath>
#include <limits>

#include "libs/core/index.hpp"

namespace palpate::force_estimation {

namespace {

/// Of one feature. Camera frame, but for `match`.
struct NormalLine {
  Eigen::Vector3d point_m;
  Eigen::Vector3d normal;
};

/// Index of the cloud point nearest to the line; the lowest of several.
Eigen::Index NearestTo(const NormalLine& line, const Eigen::Matrix3Xf& points_m) {
  const Eigen::Vector3f origin_m = line.point_m.cast<float>();
  const Eigen::Vector3f normal = line.normal.cast<float>();
  Eigen::Index nearest = 0;
  float least_m2 = std::numeric_limits<float>::infinity();
  for (Eigen::Index k = 0; k < points_m.cols(); ++k) {
    const Eigen::Vector3f from_m = points_m.col(k) - origin_m;
    const float along_m = from_m.dot(normal);
    const float squared_m2 = from_m.squaredNorm() - along_m * along_m;
    if (squared_m2 < least_m2) {
      least_m2 = squared_m2;
      nearest = k;
    }
  }
  return nearest;
}

void MatchAlong(const NormalLine& line, const rgbd::SensedCloud& cloud,
                const correspondence::MatchDistances& distances,
                correspondence::FeatureMatch* match) {
  const Eigen::Index nearest = NearestTo(line, cloud.points_m);
  const Eigen::Vector3d point_m = cloud.points_m.col(nearest).cast<double>();
  const Eigen::Vector3d offset_m = point_m - line.point_m;
  match->line_distance_m = offset_m.cross(line.normal).norm();
  if (match->line_distance_m > distances.hidden_m) return;
  match->position_m = point_m;
  match->distance_m = offset_m.norm();
  if (match->distance_m > distances.outlier_m) {
    match->state = correspondence::MatchState::kOutlier;
    match->outliers = 1;
    return;
  }
  match->state = correspondence::MatchState::kMatched;
  match->count = 1;
  match->sigma_m = static_cast<double>(cloud.sigma_m[nearest]) *
                   std::abs(line.normal.dot(point_m) / point_m.z());
}

}  // namespace

void MatchPoints(const correspondence::SurfaceFeatures& features, const rgbd::SensedCloud& cloud,
                 const Eigen::Isometry3d& T_robot_camera, const Eigen::VectorXd& x_m,
                 const correspondence::PredictedView& view,
                 const correspondence::MatchDistances& distances,
                 std::span<correspondence::FeatureMatch> matches,
                 const SurfaceMatchingTuning& tuning) {
  const Eigen::Isometry3d T_camera_robot = T_robot_camera.inverse();
  const Eigen::Matrix3Xd normals = features.Normals(x_m);
  for (int feature = 0; feature < features.Count(); ++feature) {
    correspondence::FeatureMatch& match = matches[At(feature)];
    const Eigen::Vector3d position_m = features.point(feature).Position(x_m);
    const NormalLine line{T_camera_robot * position_m,
                          T_camera_robot.linear() * normals.col(feature)};
    const bool turned_away = line.normal.dot(line.point_m) >= 0.0;
    if (turned_away || view.Hides(line.point_m, tuning.same_surface_m)) continue;
    MatchAlong(line, cloud, distances, &match);
    if (match.state != correspondence::MatchState::kMatched) continue;
    match.normal = normals.col(feature);
    match.row = robot::RowOfPoint(features.point(feature), match.normal);
    match.target_m = match.normal.dot(T_robot_camera * match.position_m);
  }
}

}  // namespace palpate::force_estimation
