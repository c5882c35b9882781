// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/observable_subspace.hpp"

#include <Eigen/Eigenvalues>

#include "libs/core/index.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::force_estimation {

namespace {

struct ObservableTuning {
  /// Least information of a direction, in units of 1 / largest_sigma_N^2. Any value far below 1
  /// removes the direction; one near rounding would make the covariance of the others inexact.
  double least_information = 1e-9;
};
constexpr ObservableTuning kObservableTuning;

}  // namespace

void ObservableSubspace::IncludeAll(const std::vector<FitSite>& sites) {
  observability_.assign(sites.size(), Observability::kFull);
  directions_.assign(sites.size(), Eigen::Matrix3d::Identity());
  unknowns_.assign(sites.size(), 3);
  for (size_t s = 0; s < sites.size(); ++s) {
    if (sites[s].direction.isZero()) continue;
    unknowns_[s] = 1;
    directions_[s].col(0) = sites[s].direction;
  }
  BuildBasis();
}

void ObservableSubspace::BuildBasis() {
  Eigen::Index columns = 0;
  for (const int unknowns : unknowns_) columns += unknowns;
  basis_ = fem::QpMatrix::Zero(ToIndex(3 * directions_.size()), columns);
  Eigen::Index column = 0;
  for (size_t s = 0; s < directions_.size(); ++s) {
    const Eigen::Index unknowns = unknowns_[s];
    basis_.block(ToIndex(3 * s), column, 3, unknowns) = directions_[s].leftCols(unknowns);
    column += unknowns;
  }
  BuildUnfitted();
}

void ObservableSubspace::BuildUnfitted() {
  unfitted_sites_.clear();
  for (size_t s = 0; s < directions_.size(); ++s) {
    if (observability_[s] != Observability::kNormal) continue;
    unfitted_sites_.insert(unfitted_sites_.end(), static_cast<size_t>(3 - unknowns_[s]),
                           static_cast<int>(s));
  }
  unfitted_ = fem::QpMatrix::Zero(ToIndex(3 * directions_.size()), ToIndex(unfitted_sites_.size()));
  Eigen::Index column = 0;
  for (size_t s = 0; s < directions_.size(); ++s) {
    if (observability_[s] != Observability::kNormal) continue;
    for (Eigen::Index k = unknowns_[s]; k < 3; ++k) {
      unfitted_.block<3, 1>(ToIndex(3 * s), column++) = directions_[s].col(k);
    }
  }
}

void ObservableSubspace::KeepObservable(const std::vector<FitSite>& sites,
                                        const fem::QpMatrix& information, double largest_sigma_N) {
  const double limit = largest_sigma_N * largest_sigma_N;
  const fem::QpMatrix reduced = basis_.transpose() * information * basis_;
  const linalg::SmallSymmetricEigen eigen = linalg::DecomposeSymmetric(reduced);
  // Directions without any information get a variance that is large, yet finite.
  const fem::QpVector variances =
      eigen.values.cwiseMax(kObservableTuning.least_information / limit).cwiseInverse();
  const fem::QpMatrix covariance = basis_ * eigen.vectors * variances.asDiagonal() *
                                   eigen.vectors.transpose() * basis_.transpose();
  for (size_t s = 0; s < sites.size(); ++s) {
    const auto row = ToIndex(3 * s);
    const Eigen::Matrix3d own_covariance = covariance.block<3, 3>(row, row);
    if (!sites[s].direction.isZero()) {
      if (own_covariance.trace() <= limit) continue;
      observability_[s] = Observability::kNone;
      unknowns_[s] = 0;
      continue;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> own(own_covariance);
    if (own.eigenvalues()[2] <= limit) continue;
    const Eigen::Vector3d normal = sites[s].patch.normal;
    const bool normal_known = normal.dot(own_covariance * normal) <= limit;
    observability_[s] = normal_known ? Observability::kNormal : Observability::kNone;
    if (normal_known) {
      KeepNormal(sites[s], s, own_covariance, limit);
      continue;
    }
    directions_[s] = own.eigenvectors();
    unknowns_[s] = 0;
    while (unknowns_[s] < 3 && own.eigenvalues()[unknowns_[s]] <= limit) ++unknowns_[s];
  }
  BuildBasis();
}

/// Keeps the normal and, where it is certain enough, the better known tangent. The force along the
/// other is set to zero, which does not change a force along the normal.
void ObservableSubspace::KeepNormal(const FitSite& site, size_t index,
                                    const Eigen::Matrix3d& covariance_N2, double limit_N2) {
  const Eigen::Vector3d normal = site.patch.normal;
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tangents.transpose() * covariance_N2 *
                                                             tangents);
  directions_[index] << normal, tangents * eigen.eigenvectors();
  unknowns_[index] = eigen.eigenvalues()[0] <= limit_N2 ? 2 : 1;
}

}  // namespace palpate::force_estimation
