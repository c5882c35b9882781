// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/fit/observable_subspace.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Where ContactSearch looks for a contact: the robot's feature points, and, where the robot file
/// does not give these, finer places of its contact surface (robot::ContactSurface).
class ContactCandidates {
 public:
  /// `model` must outlive it. Throws InputError where the robot has no feature points.
  ContactCandidates(const robot::RobotModel& model, const Config& config);

  const std::vector<FitSite>& coarse() const { return coarse_; }
  double coarse_spacing_m() const { return coarse_spacing_m_; }  ///< mean distance to the next
  /// Mean distance of the fine places; that of the coarse ones where there are none.
  double fine_spacing_m() const { return fine_spacing_m_; }
  /// Fine places within the coarse spacing of any of `centres_m`, without those places themselves.
  std::vector<FitSite> FinePlaces(const std::vector<Eigen::Vector3d>& centres_m) const;

  /// What a force at `site` costs in chi-squared before any measurement, on the body at `x_m` [3n]:
  /// the square of tangential over normal force, over Config::friction_sigma; infinite for a force
  /// that pulls. The normal is the best of those of the patch's faces. 0 with Config::adhesion.
  double PriorCost(const FitSite& site, const Eigen::Vector3d& force_N,
                   const Eigen::VectorXd& x_m) const;

 private:
  const robot::RobotModel& model_;
  Config config_;
  geometry::SurfaceIndex surface_;  ///< contact surface at rest
  std::vector<FitSite> coarse_;
  double coarse_spacing_m_ = 0.0;
  double fine_spacing_m_ = 0.0;
  Eigen::Matrix3Xd fine_m_;  ///< [3 x places] at rest
};

}  // namespace palpate::force_estimation
