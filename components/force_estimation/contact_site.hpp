// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace palpate::force_estimation {

/// A given contact location on the undeformed body.
struct ContactSite {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< robot frame
  double patch_radius_m = 0.0;  ///< the force is spread over the surface within; 0: a point
  /// Unit vector, robot frame, along which the force acts (a hung weight: gravity); zero: unknown.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();

  bool operator==(const ContactSite&) const = default;
};

/// Reads Config::contacts, each "name: x, y, z[, patch radius][ along dx, dy, dz]", m. Throws
/// InputError for other text, and for a name given twice.
std::vector<ContactSite> ParseContactSites(const std::vector<std::string>& texts);

}  // namespace palpate::force_estimation
