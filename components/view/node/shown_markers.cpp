// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/shown_markers.hpp"

#include <span>

#include "components/view/frames/binary_frame.hpp"
#include "libs/core/index.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::view {

namespace {

void AddPoints(const std::string& name, const Eigen::Matrix3Xd& points_m, BinaryFrame* frame) {
  const Eigen::Matrix3Xf single_m = points_m.cast<float>();
  frame->Add(name, std::span(single_m.data(), At(single_m.size())));
}

}  // namespace

Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message, ShownMarkers* markers) {
  const std::string frame(dds::Text(message.header.frame_id));
  if (frame != geometry::kRobotFrame) {
    return dds::Invalid("markers in the frame '" + frame + "' instead of the robot's");
  }
  *markers = {.stamp_ns = dds::StampNs(message.header.stamp)};
  markers->measured_m.resize(3, ToIndex(message.markers._length));
  markers->sigma_m.resize(3, ToIndex(message.markers._length));
  Eigen::Index seen = 0;
  for (const auto& marker : dds::Elements(message.markers)) {
    const Eigen::Vector3d position_m = dds::ToVector(marker.position_m);
    if (!marker.valid || !position_m.allFinite()) continue;
    markers->names.emplace_back(dds::Text(marker.name));
    markers->measured_m.col(seen) = position_m;
    markers->sigma_m.col(seen) = dds::ToVector(marker.sigma_m);
    ++seen;
  }
  markers->measured_m.conservativeResize(3, seen);
  markers->sigma_m.conservativeResize(3, seen);
  return Status::Ok();
}

OutMessage MarkersMessage(const ShownMarkers& markers) {
  BinaryFrame frame("markers",
                    {{"stamp_ns", std::to_string(markers.stamp_ns)}, {"names", markers.names}});
  AddPoints("measured_m", markers.measured_m, &frame);
  if (markers.model_m.cols() > 0) AddPoints("model_m", markers.model_m, &frame);
  return BinaryMessage("markers", frame.Bytes());
}

}  // namespace palpate::view
