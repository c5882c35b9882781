// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

struct CandidateLocationsTuning {
  /// Distance of candidates, as far as their bounds allow. Larger: a faster search that may miss a
  /// narrow optimum between candidates.
  double spacing_patch_radii = 2.0;
  int fewest_candidates = 60;  ///< more: small robots are searched more finely than needed
  int most_candidates = 240;   ///< more: memory and time of each search grow in proportion
  /// More: finer locations; time and memory of the posterior grow in proportion.
  int places_per_candidate = 16;
};

/// Where on the free surface of a robot a hidden contact is searched: places, evenly spread, a few
/// millimetres apart, and among them the candidates, which are evaluated first. None is within two
/// patch radii of a fixed node.
class CandidateLocations {
 public:
  static constexpr int kNearest = 4;  ///< candidates that are kept for each place

  /// Computes all patches, in about 0.1 ms each. `patch_radius_m` > 0. Throws InputError where the
  /// whole surface is fixed.
  CandidateLocations(const robot::RobotModel& model, double patch_radius_m,
                     const CandidateLocationsTuning& tuning = {});

  int CandidateCount() const { return static_cast<int>(place_of_candidate_.size()); }
  int Count() const { return static_cast<int>(positions_m_.cols()); }
  /// The place that is a candidate.
  int PlaceOfCandidate(int candidate) const { return place_of_candidate_[At(candidate)]; }
  const Eigen::Matrix3Xd& positions_m() const { return positions_m_; }  ///< [3 x places] at rest
  /// What a contact there pushes on.
  const fem::InterpolationWeights& Patch(int place) const { return patches_[At(place)]; }
  /// Candidates nearest to a place, the nearest first; the last is repeated where there are fewer.
  const std::array<int, kNearest>& NearestCandidates(int place) const {
    return nearest_candidates_[At(place)];
  }
  double spacing_m() const { return spacing_m_; }  ///< root of the area that a place stands for
  int Nearest(const Eigen::Vector3d& rest_position_m) const;

  /// Unit outward normals at the places on the surface in the shape `x_m` [3 x places].
  Eigen::Matrix3Xd Normals(const Eigen::VectorXd& x_m) const;

 private:
  void SpreadOver(const robot::RobotModel& model, double clearance_m, int count);
  std::array<int, kNearest> CandidatesNear(const Eigen::Vector3d& position_m) const;

  Eigen::Matrix3Xi surface_triangles_;
  Eigen::Matrix3Xd positions_m_;
  std::vector<int> triangles_;    ///< [places] of the surface
  Eigen::Matrix3Xd barycentric_;  ///< [3 x places]
  std::vector<int> place_of_candidate_;
  std::vector<std::array<int, kNearest>> nearest_candidates_;
  std::vector<fem::InterpolationWeights> patches_;  ///< [places]
  double spacing_m_ = 0.0;
};

}  // namespace palpate::force_estimation
