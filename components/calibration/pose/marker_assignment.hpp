// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/calibration/pose/marker_shapes.hpp"
#include "libs/core/status.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

struct AssignmentSettings {
  double sigma_m = 0.5e-3;  ///< of a measured point, alike in all directions
  /// A point farther from its marker than so many sigma (of noise and shapes together) is none.
  double gate_sigmas = 5.0;
  /// Another assignment whose sum of squares is no more than this above the best fits as well.
  double ambiguous_below = 9.0;
  int least_matches = 5;     ///< of points with markers, fewer are no assignment; >= 4
  double least_share = 0.6;  ///< of the points that are markers; 0 to 1
  int most_triplets = 24;    ///< of measured points, that hypotheses start from
  int most_refined = 24;     ///< hypotheses that are refined
};

/// A way to tell which marker each point is.
struct AssignmentChoice {
  std::vector<int> marker_of_point;  ///< [points] index of the marker; -1: none of them
  geometry::RigidTransform T_robot_camera;
  Eigen::VectorXd tension_N;  ///< [a] rough
  double cost = 0.0;
};

struct MarkerAssignment {
  /// kUnobservable: too few points or matches, or ambiguous. kInvalidInput: not finite.
  Status status;
  bool ambiguous = false;            ///< another assignment fits as well
  std::vector<int> marker_of_point;  ///< [points] index of the marker; -1: none of them
  std::vector<int> rival;            ///< the other assignment that fits best, where there is one
  geometry::RigidTransform T_robot_camera;  ///< rough: to the error of the shapes
  Eigen::VectorXd tension_N;                ///< [a] rough
  /// Sum of squares over the variance; gate_sigmas^2 for each point without a marker.
  double cost = 0.0;
  double rival_cost = 0.0;  ///< infinite where there is no rival
  int matches = 0;
  /// All that fit as well as the best, best first, each contradicting all others; where the
  /// assignment is ambiguous two or more.
  std::vector<AssignmentChoice> choices;
};

/// Which marker each of some unlabelled points is, `points_m` [3 x n] in any one camera's frame:
/// some markers may be missing, some points may be none. Triplets of points are compared with those
/// of markers whose distances the cables can bring to theirs; each gives a pose, the points their
/// nearest markers; pose and tensions are then fitted to the matches and the matches to them in
/// turns. Deterministic. Where two assignments that contradict each other fit alike (a robot that
/// looks the same after a turn), it says so and gives none for sure.
MarkerAssignment AssignMarkers(const MarkerShapes& shapes,
                               const Eigen::Ref<const Eigen::Matrix3Xd>& points_m,
                               const AssignmentSettings& settings = {});

}  // namespace palpate::calibration
