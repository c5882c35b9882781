// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/bounded_qp.hpp"
#include "libs/fem/surface_patch.hpp"

namespace palpate::force_estimation {

/// A place where a force is fitted.
struct FitSite {
  fem::SurfacePatch patch;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit; zero: any
};

/// Which part of a contact's force the markers determine.
enum class Observability {
  kFull,    ///< all that was asked for
  kNormal,  ///< some directions are uncertain, but not the surface normal; those are left at zero
  kNone,    ///< the normal direction, or the given one, is uncertain
};

/// The components of the contact forces that are fitted, lambda_f = basis q: all that are asked
/// for, less those that the markers do not determine.
class ObservableSubspace {
 public:
  /// Every direction, or the given one, of every site.
  void AskForEverything(const std::vector<FitSite>& sites);

  /// Leaves out the directions in which a force is uncertain by more than `largest_sigma_N`, taking
  /// the other contacts' uncertainty into account. `information` [3k x 3k]: inverse covariance of
  /// lambda_f, 1/N^2.
  void KeepObservable(const std::vector<FitSite>& sites, const fem::QpMatrix& information,
                      double largest_sigma_N);

  const fem::QpMatrix& basis() const { return basis_; }                               ///< [3k x q]
  const std::vector<Observability>& observability() const { return observability_; }  ///< [k]
  const std::vector<int>& unknowns() const { return unknowns_; }  ///< [k] components fitted

 private:
  void KeepNormal(const FitSite& site, size_t index, const Eigen::Matrix3d& covariance_N2,
                  double limit_N2);
  void BuildBasis();

  std::vector<Eigen::Matrix3d> directions_;  ///< [k] the first unknowns[k] columns are fitted
  std::vector<Observability> observability_;
  std::vector<int> unknowns_;
  fem::QpMatrix basis_;
};

}  // namespace palpate::force_estimation
