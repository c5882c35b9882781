// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_fit.hpp"

namespace palpate::force_estimation {

/// What a fit says about its contacts: which act, with what force, how surely.
class ContactReport {
 public:
  /// `force_relative_sigma`: error that all forces share. `search_places`: that a hidden contact
  /// may have been found at.
  ContactReport(const ShapeConfig& config, double force_relative_sigma, int search_places);

  /// Counts the frames in which each contact's force shows, and averages the forces.
  void Judge(double t_s, ShapeFit* fit) const;
  /// The contacts that act, and are not quiet just now.
  std::vector<ContactForce> Contacts(const ShapeFit& fit) const;

 private:
  double Strength(const ShapeFit& fit, std::size_t site) const;
  Status StatusOf(const ShapeFit& fit, std::size_t site) const;
  ContactForce ContactAt(const ShapeFit& fit, std::size_t site, double inflation) const;

  ShapeConfig config_;
  double force_relative_sigma_;
  double search_places_;
};

/// Rows of the fit less the force components that were fitted.
int DegreesOfFreedom(const ShapeFit& fit);

}  // namespace palpate::force_estimation
