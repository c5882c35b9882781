// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/convert.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::player {

namespace {

std::string_view FrameId(experiment::MeasurementFrame frame) {
  return frame == experiment::MeasurementFrame::kRobot ? geometry::kRobotFrame
                                                       : geometry::kCameraDepthOpticalFrame;
}

uint8_t ReferenceCode(MarkerReference reference) {
  switch (reference) {
    case MarkerReference::kNone: return palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_NONE;
    case MarkerReference::kUndeformed:
      return palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_UNDEFORMED;
    case MarkerReference::kEquilibrium:
      return palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_EQUILIBRIUM;
  }
  PALPATE_CHECK(false, static_cast<int>(reference));
  return 0;
}

/// One number for each cable, NaN where it has none; nothing where no cable has any.
template <typename Sequence>
void SetInputs(Sequence& sequence, const std::vector<CableInput>& cables,
               std::optional<double> CableInput::*input) {
  const bool any = std::any_of(cables.begin(), cables.end(),
                               [&](const CableInput& cable) { return (cable.*input).has_value(); });
  if (!any) return;
  std::vector<double> values;
  for (const CableInput& cable : cables) {
    values.push_back((cable.*input).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  dds::SetNumbers(sequence, values.data(), values.size());
}

}  // namespace

int64_t StampOf(const Event& event, double start_time_s) {
  const int64_t t_ns = event.t_ns ? *event.t_ns : std::llround(event.t_s * 1e9);
  return std::llround(start_time_s * 1e9) + t_ns;
}

dds::Message<idl::palpate_msgs::MarkerArray3> ToMarkerArray(const Event& event, int64_t stamp_ns) {
  PALPATE_CHECK(event.markers.has_value(), event.recording, event.t_s);
  const MarkerSet& set = *event.markers;
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, stamp_ns, FrameId(set.frame));
  message->counter = set.counter;
  dds::SetText(message->recording, event.recording);
  message->reference_shape = ReferenceCode(set.reference);
  if (set.pose_error) {
    dds::SetVector(message->pose_about_m, set.pose_about_m);
    message->pose_translation_sigma_m = set.pose_error->translation_m;
    message->pose_rotation_sigma_rad = set.pose_error->rotation_rad;
  }
  dds::Resize(message->markers, set.markers.size());
  for (size_t i = 0; i < set.markers.size(); ++i) {
    const Marker& marker = set.markers[i];
    auto& target = message->markers._buffer[i];
    // Whoever reads knows the robot's names only: an unnamed point goes out without one.
    if (!experiment::IsUnlabelled(marker.name)) dds::SetText(target.name, marker.name);
    target.sigma_m = {marker.sigma_m.x(), marker.sigma_m.y(), marker.sigma_m.z()};
    target.valid = marker.position_m.has_value();
    if (!marker.position_m) continue;
    target.position_m = {marker.position_m->x(), marker.position_m->y(), marker.position_m->z()};
  }
  return message;
}

dds::Message<idl::sensor_msgs::JointState> ToJointState(const Event& event, int64_t stamp_ns) {
  dds::Message<idl::sensor_msgs::JointState> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  dds::Resize(message->name, event.cables.size());
  for (size_t i = 0; i < event.cables.size(); ++i) {
    dds::SetText(message->name._buffer[i], event.cables[i].cable);
  }
  SetInputs(message->position, event.cables, &CableInput::displacement_m);
  SetInputs(message->effort, event.cables, &CableInput::tension_N);
  return message;
}

}  // namespace palpate::player
