// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/texture_motion.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/geometry/ray.hpp"

namespace palpate::force_estimation {

namespace {

/// Sums over the points become their mean, the sum of variances its sigma.
void TakeMean(TextureMatch* match) {
  const double share = 1.0 / match->count;
  match->target_m *= share;
  match->sigma_m = share * std::sqrt(match->sigma_m);
  for (robot::ObservationRow& row : match->rows) {
    for (Eigen::Vector3d& coefficient : row.coefficients) coefficient *= share;
  }
}

/// Adds a share of the coordinate of a point along `direction`.
void AddTo(robot::ObservationRow* row, const fem::InterpolationWeights& point,
           const Eigen::Vector3d& direction) {
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    const auto at = std::lower_bound(row->nodes.begin(), row->nodes.end(), point.nodes[k]);
    const auto index = at - row->nodes.begin();
    const Eigen::Vector3d share = point.weights[k] * direction;
    if (at != row->nodes.end() && *at == point.nodes[k]) {
      row->coefficients[At(index)] += share;
    } else {
      row->nodes.insert(at, point.nodes[k]);
      row->coefficients.insert(row->coefficients.begin() + index, share);
    }
  }
}

}  // namespace

TextureMotion::Line TextureMotion::LineOf(const ShapeView& view, Eigen::Index point) {
  const Eigen::Vector3d direction = view.texture.directions.col(point).cast<double>();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Line line;
  line.origin_m = view.T_robot_camera * view.texture.origin_m;
  line.direction = view.T_robot_camera.linear() * direction;
  line.across.col(0) =
      view.T_robot_camera.linear() * (right - right.dot(direction) * direction).normalized();
  line.across.col(1) = line.direction.cross(line.across.col(0));
  return line;
}

bool TextureMotion::Bind(const Line& line, const Eigen::VectorXd& x_m, Bound* bound) const {
  const Eigen::Map<const Eigen::Matrix3Xd> nodes_m(x_m.data(), 3, x_m.size() / 3);
  const auto hit =
      geometry::FirstOnRay({nodes_m, features_.triangles()}, line.origin_m, line.direction);
  if (!hit) return false;
  bound->feature = features_.FeatureOfTriangle(hit->triangle);
  bound->distance_m = hit->distance_m;
  for (int corner = 0; corner < 3; ++corner) {
    bound->point.nodes.push_back(features_.triangles()(corner, hit->triangle));
    bound->point.weights.push_back(hit->barycentric[corner]);
  }
  return true;
}

/// With that of the offset, a mean over the contact-free frames.
double TextureMotion::NoiseVariance_m2(const Bound& bound, double sigma_rad) {
  const double sigma_m = sigma_rad * bound.distance_m;
  return sigma_m * sigma_m * (1.0 + 1.0 / bound.frames);
}

void TextureMotion::Learn(const ShapeFrame& frame, const Eigen::VectorXd& x_m) {
  bound_.resize(std::max(bound_.size(), frame.views.size()));
  for (std::size_t camera = 0; camera < frame.views.size(); ++camera) {
    const ShapeView& view = frame.views[camera];
    for (Eigen::Index k = 0; k < view.texture.Count(); ++k) {
      const Line line = LineOf(view, k);
      Bound& bound = bound_[camera][view.texture.ids[At(k)]];
      if (bound.frames == 0 && bound.point.nodes.empty() && !Bind(line, x_m, &bound)) continue;
      const Eigen::Vector2d off_m =
          line.across.transpose() * (line.origin_m - bound.point.Position(x_m));
      bound.offset_m += (off_m - bound.offset_m) / ++bound.frames;
    }
  }
}

const std::vector<TextureMatch>& TextureMotion::Match(const ShapeFrame& frame) {
  matches_.clear();
  const auto count = At(features_.Count());
  for (std::size_t camera = 0; camera < std::min(bound_.size(), frame.views.size()); ++camera) {
    const ShapeView& view = frame.views[camera];
    std::vector<TextureMatch> of_feature(count);
    for (Eigen::Index k = 0; k < view.texture.Count(); ++k) {
      const auto known = bound_[camera].find(view.texture.ids[At(k)]);
      if (known == bound_[camera].end() || known->second.frames == 0) continue;
      const Bound& bound = known->second;
      const Line line = LineOf(view, k);
      TextureMatch& match = of_feature[At(bound.feature)];
      if (match.count++ == 0) match.place = bound.point;
      match.target_m += line.across.transpose() * line.origin_m - bound.offset_m;
      for (int i = 0; i < 2; ++i) AddTo(&match.rows[At(i)], bound.point, line.across.col(i));
      match.sigma_m += NoiseVariance_m2(bound, view.texture.sigma_rad[k]);
    }
    for (std::size_t feature = 0; feature < count; ++feature) {
      TextureMatch& match = of_feature[feature];
      if (match.count == 0) continue;
      match.feature = static_cast<int>(feature);
      match.number = camera * count + feature;
      TakeMean(&match);
      matches_.push_back(std::move(match));
    }
  }
  return matches_;
}

}  // namespace palpate::force_estimation
