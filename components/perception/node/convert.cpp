// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/convert.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/dds/camera_messages.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::perception {

namespace {

using dds::Invalid;

using idl::sensor_msgs::Image;

Status CheckFrame(const idl::std_msgs::Header& header, bool color) {
  const std::string_view frame = dds::Text(header.frame_id);
  if (frame == geometry::kCameraDepthOpticalFrame) return Status::Ok();
  if (color && frame == geometry::kCameraColorOpticalFrame) return Status::Ok();
  return Invalid("frame '" + std::string(frame) + "' instead of '" +
                 std::string(geometry::kCameraDepthOpticalFrame) + "'");
}

Status CheckImage(const Image& message, std::string_view encoding, std::uint32_t pixel_bytes) {
  if (dds::Text(message.encoding) != encoding || message.is_bigendian) {
    return Invalid("encoding '" + std::string(dds::Text(message.encoding)) +
                   (message.is_bigendian ? "', big-endian," : "'") + " instead of '" +
                   std::string(encoding) + "'");
  }
  return dds::CheckImageSize(message, pixel_bytes);
}

template <typename Target>
Status CopyImage(const Image& message, std::string_view encoding, Target* image) {
  constexpr std::uint32_t kPixelBytes =
      sizeof(typename decltype(image->values)::value_type) * Target::channels;
  if (Status status = CheckImage(message, encoding, kPixelBytes); !status.ok()) return status;
  *image = Target(static_cast<int>(message.width), static_cast<int>(message.height));
  const std::size_t row_bytes = std::size_t{message.width} * kPixelBytes;
  auto* target = reinterpret_cast<std::uint8_t*>(image->values.data());
  for (std::size_t v = 0; v < message.height; ++v) {
    std::memcpy(target + v * row_bytes, message.data._buffer + v * message.step, row_bytes);
  }
  return Status::Ok();
}

}  // namespace

Status FromDepthImage(const Image& message, rgbd::DepthImage* image) {
  if (Status frame = CheckFrame(message.header, false); !frame.ok()) return frame;
  return CopyImage(message, "16UC1", image);
}

Status FromColorImage(const Image& message, rgbd::ColorImage* image) {
  if (Status frame = CheckFrame(message.header, true); !frame.ok()) return frame;
  return CopyImage(message, "rgb8", image);
}

Status FromCameraSetup(const idl::palpate_msgs::CameraSetup& message, CameraSetup* setup) {
  if (!std::isfinite(message.depth_unit_m) || message.depth_unit_m <= 0.0) {
    return Invalid("a depth unit that is no length");
  }
  if (message.invalid_value > 0xFFFF) {
    return Invalid("invalid value " + std::to_string(message.invalid_value) + " beyond 16 bits");
  }
  if (!std::isfinite(message.baseline_m) || message.baseline_m < 0.0) {
    return Invalid("a baseline that is no length");
  }
  CameraSetup read;
  if (!dds::FromPose(message.color_in_depth, &read.camera.T_depth_color)) {
    return Invalid("the pose of the colour camera is none");
  }
  read.stamp_ns = dds::StampNs(message.header.stamp);
  read.epoch = message.epoch;
  read.device = dds::Text(message.device);
  read.camera.depth_unit_m = message.depth_unit_m;
  read.camera.invalid_value = static_cast<int>(message.invalid_value);
  read.camera.baseline_m = message.baseline_m;
  read.camera.color_registered = message.color_registered;
  if (message.subpixel_sigma_px > 0.0) read.subpixel_sigma_px = message.subpixel_sigma_px;
  *setup = std::move(read);
  return Status::Ok();
}

dds::Message<idl::palpate_msgs::PerceptionReport> ToReport(const FrameOutcome& outcome) {
  const SegmentedFrame& frame = outcome.observation.frame;
  dds::Message<idl::palpate_msgs::PerceptionReport> report;
  dds::SetHeader(report->header, outcome.stamp_ns, geometry::kCameraDepthOpticalFrame);
  report->frame_counter = outcome.frame_counter;
  report->epoch = outcome.epoch;
  dds::SetText(report->device, outcome.device);
  dds::SetPicture(report->picture, outcome.picture);
  dds::SetText(report->status, ToString(frame.status.code()));
  dds::SetText(report->reason, frame.status.message());
  report->robot_points = static_cast<std::uint32_t>(frame.robot.Count());
  report->object_points = static_cast<std::uint32_t>(frame.object.Count());
  report->contacts = static_cast<std::uint32_t>(outcome.observation.contacts.size());
  report->invalid_depth = static_cast<std::uint64_t>(frame.rejected.invalid_depth);
  report->out_of_range = static_cast<std::uint64_t>(frame.rejected.out_of_range);
  report->isolated = static_cast<std::uint64_t>(frame.rejected.isolated);
  report->at_depth_edge = static_cast<std::uint64_t>(frame.rejected.at_depth_edge);
  report->ambiguous = static_cast<std::uint64_t>(frame.rejected.ambiguous);
  report->thinned = static_cast<std::uint64_t>(frame.rejected.thinned);
  const rgbd::TexturePoints& texture = outcome.observation.texture;
  dds::SetVector(report->texture_origin_m, texture.origin_m);
  dds::Resize(report->texture, texture.ids.size());
  for (std::size_t i = 0; i < texture.ids.size(); ++i) {
    auto& point = report->texture._buffer[i];
    point.id = texture.ids[i];
    Eigen::Vector3f::Map(point.direction) = texture.directions.col(ToIndex(i));
    point.sigma_rad = texture.sigma_rad[ToIndex(i)];
  }
  dds::Resize(report->notes, frame.notes.size());
  for (std::size_t i = 0; i < frame.notes.size(); ++i) {
    dds::SetText(report->notes._buffer[i], frame.notes[i]);
  }
  report->prediction_stamp = dds::TimeFromNs(outcome.prediction_stamp_ns);
  return report;
}

dds::Message<idl::palpate_msgs::ContactArray> ToContactArray(const FrameOutcome& outcome) {
  const auto& contacts = outcome.observation.contacts;
  dds::Message<idl::palpate_msgs::ContactArray> message;
  dds::SetHeader(message->header, outcome.stamp_ns, geometry::kCameraDepthOpticalFrame);
  dds::Resize(message->contacts, contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const DetectedContact& contact = contacts[i];
    auto& target = message->contacts._buffer[i];
    dds::SetText(target.name, contact.name);
    dds::SetVector(target.position_m, contact.position_m);
    target.patch_radius_m = 0.5 * contact.extent_m.maxCoeff();
    target.point_count = static_cast<std::uint32_t>(contact.point_count);
    dds::SetVector(target.extent_m, contact.extent_m);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        target.position_covariance_m2[3 * row + column] = contact.covariance_m2(row, column);
      }
    }
  }
  return message;
}

}  // namespace palpate::perception
