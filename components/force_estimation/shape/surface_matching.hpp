// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/correspondence/feature_match.hpp"
#include "libs/correspondence/surface_features.hpp"

namespace palpate::force_estimation {

/// Algorithm 3 of the paper, with two ways to match: `point` takes the cloud point nearest to the
/// normal line, as published; `patch` (the default) takes all cloud points that lie on the
/// feature's share of the surface, found through the camera's view of the predicted surface, and
/// averages their distances to it (robust mean), so that no measurement is thrown away.
/// What the camera cannot see of the predicted surface (its own body hides it, or it is turned
/// away) is hidden, whatever the cloud says; what it sees at a grazing angle counts little.
///
/// d_m of 0 is twice the distance between neighbouring cloud points; d_l of 0 is 15 mm, by which a
/// surface may move between two frames, and three sigmas of the cloud. For a patch d_m is how far
/// beside the silhouette a cloud point may lie.
class SurfaceMatching {
 public:
  SurfaceMatching(const correspondence::SurfaceFeatures& features, const ShapeConfig& config);
  ~SurfaceMatching();

  /// `x_m` [3n] the model's nodes, robot frame. One entry for each feature; holds until the next
  /// call. Cloud points farther than d_l from the surface count as outliers. Everything must be
  /// finite and the cloud's sigmas above 0.
  const std::vector<correspondence::FeatureMatch>& Match(const ShapeFrame& frame,
                                                         const Eigen::VectorXd& x_m);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::force_estimation
