// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/correspondence/patch_matching.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::correspondence {

namespace {

/// Cosine between line of sight and normal from which on a point counts (75 degrees) and counts in
/// full (60 degrees). At grazing angles errors across the line of sight turn into height.
constexpr double kGrazing = 0.26;
constexpr double kFullSight = 0.5;
/// A mean over fewer points is none.
constexpr int kFewestPoints = 8;
/// Facets and rounding, m.
constexpr double kFloor_m = 1e-5;

double SightWeight(double cosine) {
  return std::clamp((cosine - kGrazing) / (kFullSight - kGrazing), 0.0, 1.0);
}

}  // namespace

void PatchMatching::Match(const rgbd::SensedCloud& cloud, const Eigen::Isometry3d& T_robot_camera,
                          const MovingSurface& surface, const PredictedView& view,
                          const MatchDistances& distances, std::span<FeatureMatch> matches) {
  coefficient_.assign(static_cast<size_t>(surface.vertices_m().cols()), Eigen::Vector3d::Zero());
  outlier_height_m_.assign(matches.size(), 0.0);
  Land(cloud, surface, view, distances, matches);
  SortByFeature();
  for (int feature = 0; feature < features_.Count(); ++feature) {
    Conclude(feature, T_robot_camera, surface, &matches[At(feature)]);
  }
}

void PatchMatching::Land(const rgbd::SensedCloud& cloud, const MovingSurface& surface,
                         const PredictedView& view, const MatchDistances& distances,
                         std::span<FeatureMatch> matches) {
  landings_.clear();
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d point_m = cloud.points_m.col(k).cast<double>();
    const int seen = view.TriangleAt(point_m, distances.hidden_m);
    if (seen == rgbd::SurfaceView::kNothing) continue;
    const SurfaceFoot foot = surface.FootOf(point_m, seen);
    if (foot.triangle < 0) continue;
    const double towards = -foot.normal.dot(point_m);
    const double weight = SightWeight(towards / point_m.norm());
    if (weight <= 0.0) continue;
    const int feature = features_.FeatureOfTriangle(foot.triangle);
    if (foot.distance_m > distances.outlier_m) {
      ++matches[At(feature)].outliers;
      outlier_height_m_[At(feature)] += foot.distance_m;
      continue;
    }
    if (foot.beyond_sharp_ridge) continue;
    // An error of z moves the point along its line of sight.
    const double sigma_m = static_cast<double>(cloud.sigma_m[k]);
    landings_.push_back({.point_m = point_m,
                         .foot = foot,
                         .sigma_m = sigma_m * towards / std::abs(point_m.z()),
                         .weight = weight / (sigma_m * sigma_m),
                         .feature = feature});
  }
}

/// Counting sort; the cloud's order stays within a feature.
void PatchMatching::SortByFeature() {
  begin_.assign(static_cast<size_t>(features_.Count()) + 1, 0);
  for (const Landing& landing : landings_) ++begin_[static_cast<size_t>(landing.feature) + 1];
  for (size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  next_ = begin_;
  order_.resize(landings_.size());
  for (size_t k = 0; k < landings_.size(); ++k) {
    int& next = next_[At(landings_[k].feature)];
    order_[At(next++)] = static_cast<int>(k);
  }
}

void PatchMatching::Conclude(int feature, const Eigen::Isometry3d& T_robot_camera,
                             const MovingSurface& surface, FeatureMatch* match) {
  const int begin = begin_[At(feature)];
  const int end = begin_[static_cast<size_t>(feature) + 1];
  match->count = end - begin;
  if (match->outliers >= kFewestPoints && match->outliers > match->count) {
    match->state = MatchState::kOutlier;
    match->distance_m = outlier_height_m_[At(feature)] / match->outliers;
    return;
  }
  if (match->count < kFewestPoints) return;
  WeighLandings(begin, end);
  match->state = MatchState::kMatched;
  match->sigma_m = std::hypot(weight_.cwiseProduct(sigma_m_).norm(), kFloor_m);
  match->distance_m = std::abs(weight_.dot(height_m_));
  AddRow(begin, end, T_robot_camera.linear(), surface, match);
  match->target_m += match->normal.dot(T_robot_camera.translation());
}

/// Final weights of the landings of one feature; they add up to 1.
void PatchMatching::WeighLandings(int begin, int end) {
  height_m_.resize(end - begin);
  sigma_m_.resize(end - begin);
  weight_.resize(end - begin);
  for (int k = begin; k < end; ++k) {
    const Landing& landing = landings_[At(order_[At(k)])];
    height_m_[k - begin] = landing.foot.height_m;
    sigma_m_[k - begin] = landing.sigma_m;
    weight_[k - begin] = landing.weight;
  }
  mean_.LowerWeights(height_m_, sigma_m_, weight_);
  weight_ /= weight_.sum();
}

/// Row, mean normal and position, and the target but for the camera's place.
void PatchMatching::AddRow(int begin, int end, const Eigen::Matrix3d& R_robot_camera,
                           const MovingSurface& surface, FeatureMatch* match) {
  touched_.clear();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int k = begin; k < end; ++k) {
    const double weight = weight_[k - begin];
    if (weight <= 0.0) continue;
    const Landing& landing = landings_[At(order_[At(k)])];
    normal += weight * landing.foot.normal;
    match->position_m += weight * landing.point_m;
    match->target_m += weight * landing.foot.normal.dot(landing.point_m);
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = surface.triangles()(corner, landing.foot.triangle);
      Eigen::Vector3d& sum = coefficient_[At(vertex)];
      if (sum.isZero(0.0)) touched_.push_back(vertex);
      sum += weight * landing.foot.barycentric[corner] * landing.foot.normal;
    }
  }
  match->normal = R_robot_camera * normal;
  std::sort(touched_.begin(), touched_.end());
  for (const int vertex : touched_) {
    Eigen::Vector3d& sum = coefficient_[At(vertex)];
    if (sum.isZero(0.0)) continue;  // named twice
    match->row.nodes.push_back(surface.NodeOfVertex(vertex));
    match->row.coefficients.push_back(R_robot_camera * sum);
    sum.setZero();
  }
}

}  // namespace palpate::correspondence
