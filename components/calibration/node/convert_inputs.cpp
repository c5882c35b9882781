// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/node/convert.hpp"
#include "libs/core/names.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/named_markers.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::calibration {

namespace {

using dds::Invalid;

constexpr std::uint32_t kMostFrames = 100;

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
  if (!IndexOf(request->source, sources)) {
    return Invalid(palpate::Unknown("source", request->source, sources));
  }
  if (message.frame_count > kMostFrames) {
    return Invalid("frame_count " + std::to_string(message.frame_count) + " is above " +
                   std::to_string(kMostFrames));
  }
  if (message.frame_count > 0) request->frames = static_cast<int>(message.frame_count);
  for (const char* part : dds::Elements(message.moduli)) {
    request->moduli.emplace_back(dds::Text(part));
  }
  request->actuator_gains = message.drive_gains;
  return Status::Ok();
}

Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, double sigma_m, SeenMarkers* seen) {
  if (Status status = dds::CheckFrameId(message.header, geometry::kCameraDepthOpticalFrame);
      !status.ok()) {
    return Invalid(status.message() + ": a calibration needs markers in the camera frame");
  }
  seen->stamp_ns = dds::StampNs(message.header.stamp);
  seen->markers.clear();
  std::vector<dds::NamedMarker> markers;
  if (Status status = dds::FromMarkersWithOrWithoutNames(message, names, &markers); !status.ok()) {
    return status;
  }
  for (dds::NamedMarker& marker : markers) {
    const bool has_errors = marker.sigma_m.minCoeff() > 0.0;
    if (!has_errors) marker.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    seen->markers.push_back({.marker = marker.index ? static_cast<int>(*marker.index) : -1,
                             .position_m = marker.position_m,
                             .covariance_m2 = marker.covariance_m2});
  }
  return Status::Ok();
}

}  // namespace palpate::calibration
