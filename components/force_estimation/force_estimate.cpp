// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/force_estimate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace palpate::force_estimation {

bool IsUsable(const Status& status) {
  return status.ok() || status.code() == StatusCode::kNoContact;
}

double SigmaOfSize_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2) {
  const double size_N = force_N.norm();
  if (size_N > 0.0) {
    const Eigen::Vector3d direction = force_N / size_N;
    return std::sqrt(std::max(0.0, direction.dot(covariance_N2 * direction)));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_N2, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
}

}  // namespace palpate::force_estimation
