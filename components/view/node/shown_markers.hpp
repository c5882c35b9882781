// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "components/view/serve/out_message.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::view {

/// Markers at one time; robot frame, m. Columns are as long as `names`; NaN: not seen, not known.
struct ShownMarkers {
  std::int64_t stamp_ns = 0;
  std::vector<std::string> names = {};
  Eigen::Matrix3Xd measured_m = {};
  Eigen::Matrix3Xd model_m = {};  ///< of the model's shape; [3 x 0]: no model
  Eigen::Matrix3Xd sigma_m = {};  ///< 0: not stated
};

/// The markers that were seen. kInvalidInput for another frame than the robot's.
Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message, ShownMarkers* markers);

OutMessage MarkersMessage(const ShownMarkers& markers);

}  // namespace palpate::view
