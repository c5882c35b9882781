// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/force_estimation/node/convert.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::force_estimation {

namespace {

Status Invalid(std::string reason) { return {StatusCode::kInvalidInput, std::move(reason)}; }

std::optional<size_t> IndexOf(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<size_t>(found - names.begin());
}

std::string Unknown(const std::string& what, std::string_view name,
                    const std::vector<std::string>& names) {
  return "unknown " + what + " '" + std::string(name) + "'" + DidYouMean(name, names);
}

bool ToReference(uint8_t code, ReferenceShape* reference) {
  switch (code) {
    case palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_NONE:
      *reference = ReferenceShape::kNone;
      return true;
    case palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_UNDEFORMED:
      *reference = ReferenceShape::kUndeformed;
      return true;
    case palpate_msgs_msg_MarkerArray3_Constants_REFERENCE_EQUILIBRIUM:
      *reference = ReferenceShape::kEquilibrium;
      return true;
    default: return false;
  }
}

/// The number for entry `index`; NaN, and a sequence that is empty, mean that it is not known.
template <typename Sequence>
std::optional<double> NumberAt(const Sequence& sequence, size_t index) {
  if (sequence._length == 0 || std::isnan(sequence._buffer[index])) return std::nullopt;
  return sequence._buffer[index];
}

template <typename Sequence>
bool FitsNames(const Sequence& sequence, const idl::sensor_msgs::JointState& message) {
  return sequence._length == 0 || sequence._length == message.name._length;
}

}  // namespace

FrameHead HeadOf(const idl::palpate_msgs::MarkerArray3& message,
                 std::chrono::steady_clock::time_point taken) {
  return {dds::StampNs(message.header.stamp), message.counter,
          std::string(dds::Text(message.recording)), taken};
}

Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, MarkerFrame* frame) {
  const std::string_view frame_id = dds::Text(message.header.frame_id);
  if (frame_id != geometry::kRobotFrame) {
    return Invalid("frame_id is '" + std::string(frame_id) + "', expected '" +
                   std::string(geometry::kRobotFrame) + "'");
  }
  if (!ToReference(message.reference_shape, &frame->reference)) {
    return Invalid("unknown reference_shape " + std::to_string(message.reference_shape));
  }
  frame->t_s = 1e-9 * static_cast<double>(dds::StampNs(message.header.stamp));
  frame->markers.assign(names.size(), MarkerObservation());
  std::vector<bool> seen(names.size(), false);
  for (const auto& marker : dds::Elements(message.markers)) {
    const auto index = IndexOf(names, dds::Text(marker.name));
    if (!index) return Invalid(Unknown("marker", dds::Text(marker.name), names));
    if (seen[*index]) return Invalid("marker '" + names[*index] + "' comes twice");
    seen[*index] = true;
    if (!marker.valid) continue;
    const Eigen::Vector3d position_m(marker.position_m.x, marker.position_m.y, marker.position_m.z);
    const Eigen::Vector3d sigma_m(marker.sigma_m.x, marker.sigma_m.y, marker.sigma_m.z);
    if (!position_m.allFinite() || !sigma_m.allFinite() || sigma_m.minCoeff() < 0.0) {
      return Invalid("position or sigma of marker '" + names[*index] + "' is not finite");
    }
    frame->markers[*index] = {true, position_m, sigma_m};
  }
  return Status::Ok();
}

Status LookedFrom(const idl::palpate_msgs::PerceptionReport& message) {
  const std::string_view word = dds::Text(message.status);
  if (word == ToString(StatusCode::kOk)) return Status::Ok();
  for (const StatusCode code : {StatusCode::kStale, StatusCode::kNoCalibration,
                                StatusCode::kInvalidInput, StatusCode::kNotRun}) {
    if (word == ToString(code)) return {code, std::string(dds::Text(message.reason))};
  }
  return {StatusCode::kNoRobotSeen, std::string(dds::Text(message.reason))};
}

Status FromContactArray(const idl::palpate_msgs::ContactArray& message,
                        const Eigen::Isometry3d& T_robot_camera,
                        std::vector<SeenContact>* contacts) {
  using Covariance = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  contacts->clear();
  for (const auto& contact : dds::Elements(message.contacts)) {
    SeenContact seen;
    seen.name = dds::Text(contact.name);
    seen.position_m = {contact.position_m.x, contact.position_m.y, contact.position_m.z};
    seen.covariance_m2 = Eigen::Map<const Covariance>(contact.position_covariance_m2);
    seen.extent_m = {contact.extent_m.x, contact.extent_m.y, contact.extent_m.z};
    seen.point_count = static_cast<int>(contact.point_count);
    if (!seen.position_m.allFinite() || !seen.covariance_m2.allFinite() ||
        !seen.extent_m.allFinite()) {
      return Invalid("contact '" + seen.name + "' is not finite");
    }
    contacts->push_back(InRobotFrame(seen, T_robot_camera));
  }
  return Status::Ok();
}

Status FromJointState(const idl::sensor_msgs::JointState& message,
                      const std::vector<std::string>& names, CableSample* sample) {
  if (!FitsNames(message.position, message) || !FitsNames(message.effort, message)) {
    return Invalid("/robot/joint_states: " + std::to_string(message.name._length) + " names, " +
                   std::to_string(message.position._length) + " positions, " +
                   std::to_string(message.effort._length) + " efforts");
  }
  sample->stamp_ns = dds::StampNs(message.header.stamp);
  sample->cables.assign(names.size(), {});
  for (size_t i = 0; i < message.name._length; ++i) {
    const std::string_view name = dds::Text(message.name._buffer[i]);
    const auto index = IndexOf(names, name);
    if (!index) return Invalid("/robot/joint_states: " + Unknown("cable", name, names));
    sample->cables[*index] = {NumberAt(message.position, i), NumberAt(message.effort, i)};
  }
  return Status::Ok();
}

}  // namespace palpate::force_estimation
