// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/convert_markers.hpp"

#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::perception {

dds::Message<idl::palpate_msgs::MarkerArray3> ToMarkerArray(const FiducialFrame& frame,
                                                            std::int64_t stamp_ns) {
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kCameraDepthOpticalFrame);
  if (!frame.status.ok()) return message;
  dds::Resize(message->markers, frame.fiducials.size());
  for (std::size_t i = 0; i < frame.fiducials.size(); ++i) {
    const Fiducial& fiducial = frame.fiducials[i];
    auto& marker = message->markers._buffer[i];
    dds::SetText(marker.name, fiducial.name);
    dds::SetVector(marker.position_m, fiducial.position_m);
    dds::SetVector(marker.sigma_m, fiducial.covariance_m2.diagonal().cwiseSqrt());
    Eigen::Map<Eigen::Matrix3d>(marker.covariance_m2) = fiducial.covariance_m2;  // symmetric
    marker.valid = true;
  }
  return message;
}

}  // namespace palpate::perception
