// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/pose/marker_shapes.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// A pose that some three points and three markers suggest.
struct PoseHypothesis {
  geometry::RigidTransform T_robot_camera;
  double cost_m2 = 0.0;  ///< squared distances of the points from the nearest markers, capped
};

/// For each point the index of its marker: pairs in the order of their distance, each point and
/// marker once, none farther apart than `gate_m`; -1: none.
std::vector<int> MatchNearest(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xd& markers_m,
                              double gate_m);

/// At most `most_triplets` triplets of points, of large triangles, no point in many more of them
/// than its share, are laid on all triplets of markers whose distances agree within
/// `distance_error_m` beside what the cables do to them. The best `most` poses, best first, no two
/// of them with the same matches of points with mean markers.
std::vector<PoseHypothesis> SuggestPoses(const MarkerShapes& shapes,
                                         const Eigen::Matrix3Xd& points_m, double distance_error_m,
                                         int most_triplets, int most);

}  // namespace palpate::calibration
