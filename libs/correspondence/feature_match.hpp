// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/robot/observation_row.hpp"

namespace palpate::correspondence {

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
  robot::ObservationRow row;     ///< of the model, in the nodes' positions
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
  int feature = 0;                                       ///< number of the feature point
  int camera = 0;                                        ///< number of the camera that sees it
};

}  // namespace palpate::correspondence
