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
  double sigma_m = 0.5e-3;  ///< standard deviation of a measured point, isotropic
  /// Largest distance of a point from its marker, in standard deviations of noise and shapes.
  double gate_sigmas = 5.0;
  /// Assignments whose chi-squared is above the best by no more than this are ambiguous.
  double ambiguous_below = 9.0;
  int least_matches = 5;     ///< smallest number of matches of an assignment; >= 4
  double least_share = 0.6;  ///< smallest share of matched points; 0 to 1
  int most_triplets = 24;    ///< of measured points, for hypotheses
  int most_refined = 24;     ///< hypotheses that are refined
};

/// One assignment with its pose and tensions.
struct AssignmentChoice {
  std::vector<int> marker_of_point;  ///< [points] index of the marker; -1: none of them
  geometry::RigidTransform T_robot_camera;
  Eigen::VectorXd tension_N;  ///< [a] rough
  double cost = 0.0;          ///< as MarkerAssignment::cost
};

struct MarkerAssignment {
  /// kUnobservable: too few points or matches, or ambiguous. kInvalidInput: not finite.
  Status status;
  bool ambiguous = false;                   ///< another assignment fits equally well
  std::vector<int> marker_of_point;         ///< [points] index of the marker; -1: none of them
  std::vector<int> rival;                   ///< the best contradicting assignment; empty: none
  geometry::RigidTransform T_robot_camera;  ///< rough: within the error of the shapes
  Eigen::VectorXd tension_N;                ///< [a] rough
  /// Chi-squared; an unmatched point costs gate_sigmas^2.
  double cost = 0.0;
  double rival_cost = 0.0;  ///< infinite without a rival
  int matches = 0;
  /// All assignments within ambiguous_below of the best, best first, contradicting each other; two
  /// or more where ambiguous.
  std::vector<AssignmentChoice> choices;
};

/// Assigns unlabelled points `points_m` [3 x n], in any camera frame, to markers. Markers may be
/// missing and points may be false. Triplets of points are matched with marker triplets of feasible
/// distances. Each match gives a pose, which is refined: nearest-neighbour matches alternate with a
/// fit of pose and tensions. Deterministic. Contradicting assignments that fit equally well (a
/// symmetric robot) make it `ambiguous`.
MarkerAssignment AssignMarkers(const MarkerShapes& shapes,
                               const Eigen::Ref<const Eigen::Matrix3Xd>& points_m,
                               const AssignmentSettings& settings = {});

}  // namespace palpate::calibration
