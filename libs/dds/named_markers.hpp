// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "palpate_msgs/msg/MarkerArray3.hpp"

namespace palpate::dds {

/// A marker that was seen; m, frame of the message.
struct NamedMarker {
  std::optional<std::size_t> index;  ///< of its name; nullopt: it has none
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< >= 0; 0: not said
  /// That of the message, else of `sigma_m` alone; 0: not said.
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// Those that were seen, in the order of the message. kInvalidInput, with the reason, for a marker
/// that is not among `names` (with "did you mean") or comes twice, a position or sigma that is not
/// finite, a sigma below 0, a covariance that is none (not finite, not symmetric, not positive
/// definite).
Status FromMarkers(const idl::palpate_msgs::MarkerArray3& message,
                   const std::vector<std::string>& names, std::vector<NamedMarker>* markers);

/// The same where markers may be without a name, any number of them.
Status FromMarkersWithOrWithoutNames(const idl::palpate_msgs::MarkerArray3& message,
                                     const std::vector<std::string>& names,
                                     std::vector<NamedMarker>* markers);

}  // namespace palpate::dds
