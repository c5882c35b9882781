// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "libs/fem/surface_patch.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// How the response to a force at a place is made from those at the nearest candidates.
inline constexpr int kSupport = 10;
struct Interpolation {
  std::array<int, kSupport> candidate{};
  std::array<double, kSupport> weight{};  ///< they add up to 1; unused ones are 0
};

/// Where on the free surface of a robot a hidden contact is looked for: places, evenly spread, a
/// few millimetres apart, and among them the candidates, for whose patches responses are solved.
/// Nothing is within two patch radii of a node that is held.
///
/// Between candidates responses are interpolated in space, not along the surface: the motion of the
/// body that a distant force excites is smooth through its thickness. The interpolation reproduces
/// affine motions (moving least squares), so a leg may turn and bend.
class SearchPlaces {
 public:
  /// `patch_radius_m` > 0. Throws InputError where the whole surface is held.
  SearchPlaces(const robot::RobotModel& model, double patch_radius_m);

  int CandidateCount() const { return static_cast<int>(patches_.size()); }
  int Count() const { return static_cast<int>(positions_m_.cols()); }
  const std::vector<fem::SurfacePatch>& patches() const { return patches_; }  ///< [candidates]
  /// The place that is a candidate.
  int PlaceOfCandidate(int candidate) const {
    return place_of_candidate_[static_cast<size_t>(candidate)];
  }
  const Eigen::Matrix3Xd& positions_m() const { return positions_m_; }  ///< [3 x places] at rest
  const Interpolation& interpolation(int place) const {
    return interpolation_[static_cast<size_t>(place)];
  }
  /// The same for any position on the surface at rest.
  Interpolation InterpolationAt(const Eigen::Vector3d& position_m) const;
  double spacing_m() const { return spacing_m_; }  ///< root of the area that a place stands for
  int Nearest(const Eigen::Vector3d& rest_position_m) const;

  /// Unit outward normals at the places on the surface in the shape `x_m` [3 x places].
  Eigen::Matrix3Xd Normals(const Eigen::VectorXd& x_m) const;

 private:
  void SpreadOver(const robot::RobotModel& model, double clearance_m, int count);
  void ChooseCandidates(const robot::RobotModel& model, double patch_radius_m, int count);
  Eigen::Matrix3Xi surface_triangles_;
  Eigen::Matrix3Xd positions_m_;
  std::vector<int> triangles_;    ///< [places] of the surface
  Eigen::Matrix3Xd barycentric_;  ///< [3 x places]
  std::vector<fem::SurfacePatch> patches_;
  std::vector<int> place_of_candidate_;
  std::vector<Interpolation> interpolation_;
  double spacing_m_ = 0.0;
};

}  // namespace palpate::force_estimation
