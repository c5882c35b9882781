// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/experiment/loads.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::force_estimation {

struct KnownContactsTuning {
  /// Of a location that was measured on the body. Larger: the fit may move the contact along the
  /// surface.
  double location_sigma_m = 5e-4;
  /// A visible contact within this distance of a known one, or within its own extent, is the same.
  /// Larger: a second contact nearby is lost; smaller: one contact is fitted twice.
  double same_contact_m = 0.015;
};

/// Known contact locations on the undeformed body, in the form of visible contacts: on the surface
/// in its present shape.
class KnownContacts {
 public:
  /// `body` must outlive it.
  explicit KnownContacts(const robot::RobotBody& body, const KnownContactsTuning& tuning = {});

  /// The nearest surface point of each site, moved along with the surface. `nodes_m` [3n]: the
  /// model's nodes, robot frame; empty: the undeformed ones.
  std::vector<SeenContact> At(const std::vector<ContactSite>& sites,
                              const Eigen::VectorXd& nodes_m) const;

 private:
  const robot::RobotBody& body_;
  KnownContactsTuning tuning_;
  geometry::SurfaceIndex rest_surface_;
};

/// Where loads act at `t_s`: load_1, load_2, ... by their order in loads.csv. Loads of zero force
/// are left out.
std::vector<ContactSite> SitesOfLoads(const std::vector<experiment::KnownLoad>& loads, double t_s);

/// `known`, and those of `seen` that are farther from each than `tuning` allows.
std::vector<SeenContact> KnownBeforeSeen(std::vector<SeenContact> known,
                                         const std::vector<SeenContact>& seen,
                                         const KnownContactsTuning& tuning = {});

}  // namespace palpate::force_estimation
