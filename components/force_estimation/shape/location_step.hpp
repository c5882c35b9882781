// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/shape/shape_site.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// One contact's location and force, estimated together from the deformation.
struct LocatedForce {
  Eigen::Vector3d step_rest_m = Eigen::Vector3d::Zero();  ///< along the undeformed surface
  Eigen::Matrix2d location_covariance_m2 = Eigen::Matrix2d::Zero();  ///< along the two tangents
  Eigen::Matrix3d force_covariance_N2 = Eigen::Matrix3d::Zero();     ///< location and force unknown
};

struct LocationStepTuning {
  /// Half the distance of the finite difference by which a patch is moved. Larger: the derivative
  /// averages over more of the surface; smaller: it shows the facets of the mesh.
  double probe_m = 1.5e-3;
  /// Prior of a hidden contact's location: it stays where the search has it, which compares all
  /// places. Larger: the local step may move it to a worse optimum.
  double hidden_sigma_m = 1e-5;
};

/// One Gauss-Newton step of forces and locations together, about a fit of the forces alone. Columns
/// of the locations are the response to moving each force along the two tangents of the surface;
/// their prior is the location in the camera image.
class LocationStep {
 public:
  /// `model` and `fitter` must outlive this.
  LocationStep(robot::RobotModel& model, ForceNewton& fitter,
               const LocationStepTuning& tuning = {});

  /// About the last fit of `fitter`, whose sites are `sites` in the same order. `residual_m`,
  /// `targets`: of its rows. kUnobservable where the problem has no unique solution.
  Status Compute(const std::vector<ShapeSite>& sites, const RowTargets& targets,
                 const ModelState& state, std::vector<LocatedForce>* located);

 private:
  /// The nodal forces of moving the site's force along both tangents, per m.
  void AddForces(const ShapeSite& site, const Eigen::Vector3d& force_N, Eigen::Index column);

  robot::RobotModel& model_;
  ForceNewton& fitter_;
  LocationStepTuning tuning_;
  Eigen::MatrixXd jacobian_;        ///< [rows x 5k] forces, then locations
  Eigen::MatrixXd nodal_forces_N_;  ///< [3n x 2k]
  Eigen::MatrixXd motions_m_;       ///< [rows x 2k]
};

/// Two unit vectors along the surface with this normal.
Eigen::Matrix<double, 3, 2> Tangents(const Eigen::Vector3d& normal);

}  // namespace palpate::force_estimation
