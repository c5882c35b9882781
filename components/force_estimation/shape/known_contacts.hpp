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

/// Places on the undeformed body where a force is known to act, as contacts that were seen: on the
/// surface in its present shape.
class KnownContacts {
 public:
  /// `body` must outlive it.
  explicit KnownContacts(const robot::RobotBody& body);

  /// The nearest surface point of each site, moved along with the surface. `nodes_m` [3n]: the
  /// model's nodes, robot frame; empty: the undeformed ones.
  std::vector<SeenContact> At(const std::vector<ContactSite>& sites,
                              const Eigen::VectorXd& nodes_m) const;

 private:
  const robot::RobotBody& body_;
  geometry::SurfaceIndex rest_surface_;
};

/// The places where loads act at `t_s`: load_1, load_2, ... by their order in loads.csv. Loads of
/// no force are left out.
std::vector<ContactSite> SitesOfLoads(const std::vector<experiment::KnownLoad>& loads, double t_s);

/// `known`, and those of `seen` that are none of them, but farther from each than they reach.
std::vector<SeenContact> KnownBeforeSeen(std::vector<SeenContact> known,
                                         const std::vector<SeenContact>& seen);

}  // namespace palpate::force_estimation
