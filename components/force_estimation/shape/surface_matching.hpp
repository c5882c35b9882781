// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/surface_features.hpp"
#include "libs/robot/effector_row.hpp"

namespace palpate::force_estimation {

/// What Algorithm 3 finds out about a feature point.
enum class MatchState {
  kMatched,
  kHidden,   ///< no point of the cloud near its normal line (d_m), or the model's own body hides it
  kOutlier,  ///< a match, but farther away than d_l
};

/// One feature point and its match, along the normal of the surface in its present shape (the
/// paper's delta_e^N and delta_c^N).
struct FeatureMatch {
  MatchState state = MatchState::kHidden;
  robot::EffectorRow row;        ///< of the model, in the nodes' positions
  double target_m = 0.0;         ///< what `row` should give
  double sigma_m = 0.0;          ///< of the target, from the depth noise alone; > 0 where matched
  int count = 0;                 ///< cloud points that stand behind it
  int outliers = 0;              ///< cloud points on its share of the surface, but beyond d_l
  double line_distance_m = 0.0;  ///< d_mini; of a patch: of the mean of its cloud points
  double distance_m = 0.0;  ///< d, from the feature point to its match; of a patch: mean height
                            ///< of its cloud points (of the outliers where it is one), >= 0
  /// Mean of the matched surface, robot frame: what target_m changes by when all cloud points move.
  /// Shorter than 1 where the surface bends.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< mean of the cloud points, camera frame
};

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
  SurfaceMatching(const SurfaceFeatures& features, const ShapeConfig& config);
  ~SurfaceMatching();

  /// `x_m` [3n] the model's nodes, robot frame. One entry for each feature; holds until the next
  /// call. Cloud points farther than d_l from the surface count as outliers. Everything must be
  /// finite and the cloud's sigmas above 0.
  const std::vector<FeatureMatch>& Match(const ShapeFrame& frame, const Eigen::VectorXd& x_m);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::force_estimation
