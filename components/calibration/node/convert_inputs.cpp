// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "components/calibration/node/convert.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::calibration {

namespace {

constexpr std::uint32_t kMostFrames = 100;

Status Invalid(std::string reason) { return {StatusCode::kInvalidInput, std::move(reason)}; }

std::optional<std::size_t> IndexOf(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::string Unknown(const std::string& what, std::string_view name,
                    const std::vector<std::string>& names) {
  return "unknown " + what + " '" + std::string(name) + "'" + DidYouMean(name, names);
}

/// The number for entry `index`; NaN, and a sequence that is empty, mean that it is not known.
template <typename Sequence>
std::optional<double> NumberAt(const Sequence& sequence, std::size_t index) {
  if (sequence._length == 0 || std::isnan(sequence._buffer[index])) return std::nullopt;
  return sequence._buffer[index];
}

template <typename Sequence>
bool FitsNames(const Sequence& sequence, const idl::sensor_msgs::JointState& message) {
  return sequence._length == 0 || sequence._length == message.name._length;
}

}  // namespace

Status FromRequest(const idl::palpate_msgs::CalibrationRequest& message, const Request& defaults,
                   Request* request) {
  *request = defaults;
  request->id = dds::Text(message.id);
  request->cancel = message.action == palpate_msgs_msg_CalibrationRequest_Constants_CANCEL;
  if (request->cancel) return Status::Ok();
  if (message.action != palpate_msgs_msg_CalibrationRequest_Constants_CALIBRATE) {
    return Invalid("unknown action " + std::to_string(message.action));
  }
  if (const std::string_view source = dds::Text(message.source); !source.empty()) {
    request->source = source;
  }
  const std::vector<std::string> sources = {"clouds", "markers"};
  if (!IndexOf(sources, request->source)) {
    return Invalid(Unknown("source", request->source, sources));
  }
  if (message.frame_count > kMostFrames) {
    return Invalid("frame_count " + std::to_string(message.frame_count) + " is above " +
                   std::to_string(kMostFrames));
  }
  if (message.frame_count > 0) request->frames = static_cast<int>(message.frame_count);
  for (const char* part : dds::Elements(message.moduli)) {
    request->moduli.emplace_back(dds::Text(part));
  }
  request->drive_gains = message.drive_gains;
  return Status::Ok();
}

Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, double sigma_m, SeenMarkers* seen) {
  const std::string_view frame_id = dds::Text(message.header.frame_id);
  if (frame_id != geometry::kCameraDepthOpticalFrame) {
    return Invalid("frame_id is '" + std::string(frame_id) + "', expected '" +
                   std::string(geometry::kCameraDepthOpticalFrame) +
                   "': the camera's pose is found from markers as the camera sees them");
  }
  seen->stamp_ns = dds::StampNs(message.header.stamp);
  seen->markers.clear();
  std::vector<bool> came(names.size(), false);
  for (const auto& marker : dds::Elements(message.markers)) {
    const auto index = IndexOf(names, dds::Text(marker.name));
    if (!index) return Invalid(Unknown("marker", dds::Text(marker.name), names));
    if (came[*index]) return Invalid("marker '" + names[*index] + "' comes twice");
    came[*index] = true;
    if (!marker.valid) continue;
    const Eigen::Vector3d position_m(marker.position_m.x, marker.position_m.y, marker.position_m.z);
    Eigen::Vector3d sigmas_m(marker.sigma_m.x, marker.sigma_m.y, marker.sigma_m.z);
    if (!position_m.allFinite() || !sigmas_m.allFinite() || sigmas_m.minCoeff() < 0.0) {
      return Invalid("position or sigma of marker '" + names[*index] + "' is not finite");
    }
    if (sigmas_m.minCoeff() == 0.0) sigmas_m.setConstant(sigma_m);
    seen->markers.push_back({.marker = static_cast<int>(*index),
                             .position_m = position_m,
                             .covariance_m2 = sigmas_m.cwiseAbs2().asDiagonal()});
  }
  return Status::Ok();
}

Status FromJointState(const idl::sensor_msgs::JointState& message,
                      const std::vector<std::string>& names, CableReading* reading) {
  if (!FitsNames(message.position, message) || !FitsNames(message.effort, message)) {
    return Invalid("/robot/joint_states: " + std::to_string(message.name._length) + " names, " +
                   std::to_string(message.position._length) + " positions, " +
                   std::to_string(message.effort._length) + " efforts");
  }
  reading->stamp_ns = dds::StampNs(message.header.stamp);
  reading->cables.assign(names.size(), {});
  for (std::size_t i = 0; i < message.name._length; ++i) {
    const std::string_view name = dds::Text(message.name._buffer[i]);
    const auto index = IndexOf(names, name);
    if (!index) return Invalid("/robot/joint_states: " + Unknown("cable", name, names));
    reading->cables[*index] = {NumberAt(message.position, i), NumberAt(message.effort, i)};
  }
  return Status::Ok();
}

}  // namespace palpate::calibration
