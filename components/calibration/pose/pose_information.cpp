// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/pose_information.hpp"

#include <Eigen/Cholesky>

#include "libs/geometry/rigid_registration.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::calibration {

using Eigen::Index;

SightingWhitener::SightingWhitener(const std::vector<MarkerSighting>& sightings) {
  for (const MarkerSighting& sighting : sightings) {
    const Eigen::LLT<Eigen::Matrix3d> factor(sighting.covariance_m2);
    inverse_factors_.emplace_back(factor.matrixL().solve(Eigen::Matrix3d::Identity()));
  }
}

void SightingWhitener::Apply(const Eigen::Matrix3d& R_robot_camera,
                             Eigen::Ref<Eigen::MatrixXd> rows) const {
  for (size_t k = 0; k < inverse_factors_.size(); ++k) {
    const Eigen::Matrix3d whitening = inverse_factors_[k] * R_robot_camera.transpose();
    auto of_marker = rows.middleRows<3>(static_cast<Index>(3 * k));
    of_marker = (whitening * of_marker).eval();
  }
}

Eigen::MatrixXd JointCovariance(const std::vector<MarkerSighting>& sightings,
                                const SightingWhitener& whitener,
                                const geometry::RigidTransform& T_robot_camera,
                                const Eigen::MatrixXd& W_ea) {
  Eigen::MatrixXd J(W_ea.rows(), 6 + W_ea.cols());
  for (size_t k = 0; k < sightings.size(); ++k) {
    auto rows = J.middleRows<3>(static_cast<Index>(3 * k));
    rows.leftCols<3>() = -geometry::CrossMatrix(T_robot_camera.Rotate(sightings[k].position_m));
    rows.middleCols<3>(3).setIdentity();
  }
  J.rightCols(W_ea.cols()) = -W_ea;
  whitener.Apply(T_robot_camera.rotation().toRotationMatrix(), J);

  constexpr double kNothing = 1e-14;
  const Eigen::MatrixXd information = J.transpose() * J;
  Eigen::VectorXd scale = information.diagonal();
  for (double& entry : scale) entry = 1.0 / std::sqrt(std::max(entry, 1e-300));
  const Eigen::MatrixXd normalized = scale.asDiagonal() * information * scale.asDiagonal();
  const linalg::SymmetricEigen eigen = linalg::DecomposeSymmetric(normalized);
  const Eigen::VectorXd variances = eigen.values.cwiseMax(kNothing).cwiseInverse();
  const Eigen::MatrixXd scaled = eigen.vectors * variances.asDiagonal() * eigen.vectors.transpose();
  return scale.asDiagonal() * scaled * scale.asDiagonal();
}

}  // namespace palpate::calibration
