// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/bounded_qp.hpp"
#include "libs/fem/surface_patch.hpp"

namespace palpate::force_estimation {

/// A contact location at which a force is fitted.
struct FitSite {
  fem::SurfacePatch patch;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, robot frame; zero: any
};

/// Which part of a contact's force the observed rows determine.
enum class Observability {
  kFull,    ///< all components
  kNormal,  ///< the component along the surface normal; uncertain tangential ones are set to zero
  kNone,    ///< not even that along the normal, or along the given direction
};

/// The subspace in which contact forces are fitted, lambda_f = basis q: the components of all sites
/// without those that the observed rows do not determine.
class ObservableSubspace {
 public:
  /// Every direction, or the given one, of every site.
  void IncludeAll(const std::vector<FitSite>& sites);

  /// Removes the directions in which the standard deviation of a force is above `largest_sigma_N`,
  /// the other contacts' forces being unknown, too. `information` [3k x 3k]: inverse covariance of
  /// lambda_f, 1/N^2.
  void KeepObservable(const std::vector<FitSite>& sites, const fem::QpMatrix& information,
                      double largest_sigma_N);

  const fem::QpMatrix& basis() const { return basis_; }                               ///< [3k x q]
  const std::vector<Observability>& observability() const { return observability_; }  ///< [k]
  const std::vector<int>& unknowns() const { return unknowns_; }  ///< [k] components fitted
  /// The tangents [3k x u] along which forces were set to zero, where the normal is fitted; and the
  /// site of each [u].
  const fem::QpMatrix& unfitted() const { return unfitted_; }
  const std::vector<int>& unfitted_sites() const { return unfitted_sites_; }

 private:
  void KeepNormal(const FitSite& site, size_t index, const Eigen::Matrix3d& covariance_N2,
                  double limit_N2);
  void BuildBasis();
  void BuildUnfitted();

  std::vector<Eigen::Matrix3d> directions_;  ///< [k] the first unknowns[k] columns are fitted
  std::vector<Observability> observability_;
  std::vector<int> unknowns_;
  fem::QpMatrix basis_;
  fem::QpMatrix unfitted_;
  std::vector<int> unfitted_sites_;
};

}  // namespace palpate::force_estimation
