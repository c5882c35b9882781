// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "components/perception/markers/fiducial.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::perception {

/// /perception/markers of a frame: one valid marker for each fiducial, in their order, in the depth
/// camera's frame, with its covariance, and its sigmas along that frame's axes. The name is empty
/// where its marker name is unknown. No markers where `frame.status` is not ok.
/// The counter is set by the sender.
dds::Message<idl::palpate_msgs::MarkerArray3> ToMarkerArray(const FiducialFrame& frame,
                                                            std::int64_t stamp_ns);

}  // namespace palpate::perception
