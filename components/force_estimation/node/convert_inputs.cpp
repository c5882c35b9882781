// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "components/force_estimation/node/convert.hpp"
#include "libs/core/index.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/named_markers.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::force_estimation {

namespace {

using dds::Invalid;

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

Status ToPoseError(const idl::palpate_msgs::MarkerArray3& message, PoseError* error) {
  *error = {.about_m = dds::ToVector(message.pose_about_m),
            .translation_sigma_m = message.pose_translation_sigma_m,
            .rotation_sigma_rad = message.pose_rotation_sigma_rad};
  const auto is_error = [](double sigma) { return std::isfinite(sigma) && sigma >= 0.0; };
  const bool valid = error->about_m.allFinite() && is_error(error->translation_sigma_m) &&
                     is_error(error->rotation_sigma_rad);
  return valid ? Status::Ok()
               : Invalid("the standard error of the markers' pose is negative or not finite");
}

}  // namespace

FrameHead HeadOf(const idl::palpate_msgs::MarkerArray3& message,
                 std::chrono::steady_clock::time_point taken) {
  return {dds::StampNs(message.header.stamp), message.counter,
          std::string(dds::Text(message.recording)), taken};
}

Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, MarkerFrame* frame) {
  if (Status status = dds::CheckFrameId(message.header, geometry::kRobotFrame); !status.ok()) {
    return status;
  }
  if (!ToReference(message.reference_shape, &frame->reference)) {
    return Invalid("unknown reference_shape " + std::to_string(message.reference_shape));
  }
  frame->t_s = 1e-9 * static_cast<double>(dds::StampNs(message.header.stamp));
  if (Status status = ToPoseError(message, &frame->pose_error); !status.ok()) return status;
  frame->markers.assign(names.size(), MarkerObservation());
  std::vector<dds::NamedMarker> seen;
  if (Status status = dds::FromMarkers(message, names, &seen); !status.ok()) return status;
  for (const dds::NamedMarker& marker : seen) {
    frame->markers[marker.index.value()] = {true, marker.position_m, marker.sigma_m};
  }
  return Status::Ok();
}

Status StatusOfPerception(const idl::palpate_msgs::PerceptionReport& message) {
  const std::string_view word = dds::Text(message.status);
  if (word == ToString(StatusCode::kOk)) return Status::Ok();
  for (const StatusCode code : {StatusCode::kStale, StatusCode::kNoCalibration,
                                StatusCode::kInvalidInput, StatusCode::kNotRun}) {
    if (word == ToString(code)) return {code, std::string(dds::Text(message.reason))};
  }
  return {StatusCode::kNoRobotSeen, std::string(dds::Text(message.reason))};
}

Status FromTexture(const idl::palpate_msgs::PerceptionReport& message,
                   rgbd::TexturePoints* texture) {
  constexpr float kUnitTolerance = 1e-4f;
  const auto count = ToIndex(message.texture._length);
  *texture = {};
  texture->origin_m = dds::ToVector(message.texture_origin_m);
  texture->directions.resize(3, count);
  texture->sigma_rad.resize(count);
  bool is_valid = texture->origin_m.allFinite();
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto& point = message.texture._buffer[k];
    texture->ids.push_back(point.id);
    texture->directions.col(k) = Eigen::Vector3f::Map(point.direction);
    texture->sigma_rad[k] = point.sigma_rad;
    const float length = texture->directions.col(k).norm();
    is_valid = is_valid && std::abs(length - 1.0f) < kUnitTolerance && point.sigma_rad > 0.0f &&
               std::isfinite(point.sigma_rad);
  }
  if (is_valid) return Status::Ok();
  *texture = {};
  return Invalid("a point of the robot's texture is no line of sight");
}

Status FromContactArray(const idl::palpate_msgs::ContactArray& message,
                        const Eigen::Isometry3d& T_robot_camera,
                        std::vector<SeenContact>* contacts) {
  using Covariance = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  contacts->clear();
  for (const auto& contact : dds::Elements(message.contacts)) {
    SeenContact seen;
    seen.name = dds::Text(contact.name);
    seen.position_m = dds::ToVector(contact.position_m);
    seen.covariance_m2 = Eigen::Map<const Covariance>(contact.position_covariance_m2);
    seen.extent_m = dds::ToVector(contact.extent_m);
    seen.point_count = static_cast<int>(contact.point_count);
    if (!seen.position_m.allFinite() || !seen.covariance_m2.allFinite() ||
        !seen.extent_m.allFinite()) {
      return Invalid("contact '" + seen.name + "' is not finite");
    }
    contacts->push_back(InRobotFrame(seen, T_robot_camera));
  }
  return Status::Ok();
}

}  // namespace palpate::force_estimation
