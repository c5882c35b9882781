// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_fitter.hpp"

namespace palpate::force_estimation {

/// How surely something pushes with this force, over what noise alone exceeds with a chance of
/// `chance`: significant above 1. One-sided: a pull along `normal` (outward, unit) gives no more
/// than 0. Of a contact that nobody sees, which way the surface faces that it pushes on is not
/// known, so that all of the force counts where it pushes at all.
double Strength(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2,
                const Eigen::Vector3d& normal, bool hidden, double chance);

/// What a fit says about its contacts: which act, with what force, how surely.
class ContactReport {
 public:
  /// `force_relative_sigma`: error that all forces share. `candidate_locations`: that a hidden
  /// contact may have been found at.
  ContactReport(const ShapeConfig& config, double force_relative_sigma, int candidate_locations);

  /// Counts the frames in which each contact's force shows, and averages the forces. `begins`:
  /// there was no frame before in which a contact could have come.
  void Judge(double t_s, bool begins, ShapeFitter* fit) const;
  /// The contacts that act, and are not quiet just now.
  std::vector<ContactForce> Contacts(const ShapeFitter& fit) const;

 private:
  double StrengthOf(const ShapeFitter& fit, std::size_t site) const;
  Status StatusOf(const ShapeFitter& fit, std::size_t site) const;
  ContactForce ContactAt(const ShapeFitter& fit, std::size_t site, double inflation) const;

  ShapeConfig config_;
  double force_relative_sigma_;
  double search_places_;
};

/// Rows of the fit less the force components that were fitted.
int DegreesOfFreedom(const ShapeFitter& fit);

}  // namespace palpate::force_estimation
