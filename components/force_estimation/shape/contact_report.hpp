// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_fitter.hpp"

namespace palpate::force_estimation {

/// A force over the one that noise alone exceeds with the probability `chance`: significant above
/// 1. One-sided: a pull along `normal` (outward, unit) gives at most 0. Of a hidden contact the
/// normal is uncertain, so that all components count where it pushes.
double Strength(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2,
                const Eigen::Vector3d& normal, bool hidden, double chance);

struct ContactReportTuning {
  /// A site below this strength is quiet. Larger: contacts vanish while they still push; smaller:
  /// noise keeps them.
  double quiet_strength = 0.5;
  /// A site above this strength counts twice: it is reported after half of the frames. Smaller:
  /// faster reports, more false ones.
  double clear_strength = 2.0;
  /// Posterior over prior variance of the tangential force above which it counts as not observed.
  /// Larger: forces that friction's prior dominates have status ok.
  double observed_variance = 0.5;
  /// ShapeConfig::significance of a force at a visible contact where the depth bias is fitted
  /// along. Its interval is then mostly the bias', constant over the frames, so that there is no
  /// chance in each of them. Larger: forces that are no larger than their interval are reported.
  double significance_along = 0.01;
  /// Radius that holds a hidden contact's place with 95 %, of BodyScale::length_m, up to which it
  /// is reported in the first frame of a sequence. Larger: contacts that may be anywhere are, too.
  double largest_place_share = 0.25;
  double uncertain_share = Config().uncertain_share;  ///< Config::uncertain_share
};

/// The contacts of a fit: which act, their forces and uncertainties.
class ContactReport {
 public:
  /// `force_relative_sigma`: error common to all forces. `candidate_locations`: their number in the
  /// search for hidden contacts.
  ContactReport(const ShapeConfig& config, double force_relative_sigma, int candidate_locations,
                const ContactReportTuning& tuning = {});

  /// Counts the frames in which each contact's force is significant, and filters the forces.
  /// `begins`: first frame of a sequence, in which contacts may be there already.
  void Judge(double t_s, bool begins, ShapeFitter* fit) const;
  /// Whether the 95 % ellipsoid of the last fit's force holds zero, with the uncertainty of the
  /// contact's location.
  bool HoldsZero(const ShapeFitter& fit, std::size_t site) const;
  /// The contacts that act and are not quiet in this frame. Of hidden ones those whose
  /// ellipsoid does not hold zero: no image shows that something is there. Where nothing else can
  /// explain the shape, one beyond doubt is reported all the same, as kUncertain.
  std::vector<ContactForce> Contacts(const ShapeFitter& fit) const;
  /// Of a frame in which Contacts has none: kNoContact, or kUnobservable where a hidden contact is
  /// followed that is certain and cannot be reported.
  Status WithoutContacts(const ShapeFitter& fit) const;

 private:
  double StrengthOf(const ShapeFitter& fit, std::size_t site) const;
  Status StatusOf(const ShapeFitter& fit, std::size_t site) const;
  ContactForce ContactAt(const ShapeFitter& fit, std::size_t site, double inflation) const;

  ShapeConfig config_;
  ContactReportTuning tuning_;
  double force_relative_sigma_;
  double search_places_;
};

/// Rows of the fit less the force components that were fitted.
int DegreesOfFreedom(const ShapeFitter& fit);

}  // namespace palpate::force_estimation
