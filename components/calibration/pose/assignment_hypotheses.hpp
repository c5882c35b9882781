// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/pose/marker_shapes.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// Pose from a match of three points with three markers.
struct PoseHypothesis {
  geometry::RigidTransform T_robot_camera;
  double cost_m2 = 0.0;  ///< sum of squared distances to the nearest markers, capped
};

/// Greedy nearest-neighbour matching: for each point the index of its marker. Each point and marker
/// is used once, and no pair is farther apart than `gate_m`; -1: none.
std::vector<int> MatchNearest(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xd& markers_m,
                              double gate_m);

/// Registers at most `most_triplets` large triangles of points with all marker triplets whose
/// distances agree within `distance_error_m` and the range of the cables. No point is in many more
/// triangles than its share. Returns the best `most` poses, best first, with different matches of
/// points with mean markers.
std::vector<PoseHypothesis> SuggestPoses(const MarkerShapes& shapes,
                                         const Eigen::Matrix3Xd& points_m, double distance_error_m,
                                         int most_triplets, int most);

}  // namespace palpate::calibration
