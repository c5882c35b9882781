// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/fit/force_fitter.hpp"
#include "components/force_estimation/shape/shape_site.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// What the deformation says about one contact's place and force together.
struct LocatedForce {
  Eigen::Vector3d step_rest_m = Eigen::Vector3d::Zero();  ///< along the undeformed surface
  Eigen::Matrix2d location_covariance_m2 = Eigen::Matrix2d::Zero();  ///< along the two tangents
  Eigen::Matrix3d force_covariance_N2 = Eigen::Matrix3d::Zero();     ///< place and force unknown
};

/// One Gauss-Newton step of forces and places together, about a fit of the forces alone: the
/// columns of the places are the response to moving each force along the two tangents of the
/// surface, the prior is where the contact was seen.
class LocationStep {
 public:
  /// `model` and `fitter` must outlive this.
  LocationStep(robot::RobotModel& model, ForceFitter& fitter);

  /// About the last fit of `fitter`, whose sites are `sites` in the same order. `residual_m`,
  /// `targets`: of its rows. kUnobservable where the problem has no unique solution.
  Status Compute(const std::vector<ShapeSite>& sites, const RowTargets& targets,
                 const ModelState& state, std::vector<LocatedForce>* located);

 private:
  /// The nodal forces of moving the site's force along both tangents, per m.
  void AddForces(const ShapeSite& site, const Eigen::Vector3d& force_N, Eigen::Index column);

  robot::RobotModel& model_;
  ForceFitter& fitter_;
  Eigen::MatrixXd jacobian_;        ///< [rows x 5k] forces, then places
  Eigen::MatrixXd nodal_forces_N_;  ///< [3n x 2k]
  Eigen::MatrixXd motions_m_;       ///< [rows x 2k]
};

/// Two unit vectors along the surface with this normal.
Eigen::Matrix<double, 3, 2> Tangents(const Eigen::Vector3d& normal);

}  // namespace palpate::force_estimation
