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

Status CheckFrame(const idl::std_msgs::Header& header, const dds::CameraTopics& camera,
                  bool color) {
  const std::string_view frame = dds::Text(header.frame_id);
  if (frame == camera.depth_frame) return Status::Ok();
  if (color && frame == camera.color_frame) return Status::Ok();
  return Invalid("frame '" + std::string(frame) + "' instead of '" + camera.depth_frame + "'");
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

void SetTexture(const rgbd::TexturePoints& texture, idl::palpate_msgs::PerceptionReport& report) {
  dds::SetVector(report.texture_origin_m, texture.origin_m);
  dds::Resize(report.texture, texture.ids.size());
  for (std::size_t i = 0; i < texture.ids.size(); ++i) {
    auto& point = report.texture._buffer[i];
    point.id = texture.ids[i];
    Eigen::Vector3f::Map(point.direction) = texture.directions.col(ToIndex(i));
    point.sigma_rad = texture.sigma_rad[ToIndex(i)];
  }
}

void SetNotes(const std::vector<std::string>& notes, idl::palpate_msgs::PerceptionReport& report) {
  dds::Resize(report.notes, notes.size());
  for (std::size_t i = 0; i < notes.size(); ++i) dds::SetText(report.notes._buffer[i], notes[i]);
}

/// What one camera shows.
dds::Message<idl::palpate_msgs::PerceptionReport> ReportWithoutNotes(const FrameOutcome& outcome,
                                                                     std::size_t camera,
                                                                     std::string_view depth_frame) {
  const CameraOrigin& origin = outcome.cameras[camera];
  const CameraView& view = outcome.observation.views[camera];
  const SegmentedFrame& frame = view.frame;
  dds::Message<idl::palpate_msgs::PerceptionReport> report;
  dds::SetHeader(report->header, outcome.stamp_ns, depth_frame);
  report->frame_counter = origin.frame_counter;
  report->epoch = origin.epoch;
  dds::SetText(report->device, origin.device);
  dds::SetPicture(report->picture, origin.picture);
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
  SetTexture(view.texture, *report);
  report->prediction_stamp = dds::TimeFromNs(outcome.prediction_stamp_ns);
  report->camera_in_first = dds::ToPose(origin.T_first_camera);
  return report;
}

/// Points of all cameras in the frame of the first.
dds::JoinedCloud Joined(const FrameOutcome& outcome, rgbd::SensedCloud SegmentedFrame::*part) {
  Eigen::Index count = 0;
  for (const CameraView& view : outcome.observation.views) count += (view.frame.*part).Count();
  dds::JoinedCloud joined;
  joined.points.points_m.resize(3, count);
  joined.points.sigma_m.resize(count);
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < outcome.cameras.size(); ++k) {
    const rgbd::SensedCloud& cloud = outcome.observation.views[k].frame.*part;
    const Eigen::Isometry3d& T_first_camera = outcome.cameras[k].T_first_camera;
    const Eigen::Index points = cloud.Count();
    joined.points.points_m.middleCols(next, points) =
        k == 0 ? cloud.points_m
               : (T_first_camera * cloud.points_m.cast<double>()).cast<float>().eval();
    joined.points.sigma_m.segment(next, points) = cloud.sigma_m;
    auto& colors_rgb = joined.points.colors_rgb;
    colors_rgb.insert(colors_rgb.end(), cloud.colors_rgb.begin(), cloud.colors_rgb.end());
    joined.cameras.insert(joined.cameras.end(), At(points), static_cast<std::uint32_t>(k));
    next += points;
  }
  return joined;
}

}  // namespace

Status FromDepthImage(const Image& message, const dds::CameraTopics& camera,
                      rgbd::DepthImage* image) {
  if (Status frame = CheckFrame(message.header, camera, false); !frame.ok()) return frame;
  return CopyImage(message, "16UC1", image);
}

Status FromColorImage(const Image& message, const dds::CameraTopics& camera,
                      rgbd::ColorImage* image) {
  if (Status frame = CheckFrame(message.header, camera, true); !frame.ok()) return frame;
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

std::string FrameOutcome::NameOf(std::size_t camera) const {
  return camera == 0 ? "the first camera" : "camera '" + cameras[camera].name + "'";
}

dds::Message<idl::palpate_msgs::PerceptionReport> ToReport(const FrameOutcome& outcome) {
  auto report = ReportWithoutNotes(outcome, 0, geometry::kCameraDepthOpticalFrame);
  std::vector<std::string> notes = outcome.observation.views[0].frame.notes;
  notes.insert(notes.end(), outcome.notes.begin(), outcome.notes.end());
  if (outcome.cameras.size() == 1) {
    SetNotes(notes, *report);
    return report;
  }
  const Status& status = outcome.observation.status();
  dds::SetText(report->status, ToString(status.code()));
  dds::SetText(report->reason, status.message());
  report->robot_points = report->object_points = 0;
  for (std::size_t k = 0; k < outcome.cameras.size(); ++k) {
    const SegmentedFrame& frame = outcome.observation.views[k].frame;
    report->robot_points += static_cast<std::uint32_t>(frame.robot.Count());
    report->object_points += static_cast<std::uint32_t>(frame.object.Count());
    const Status& missing = outcome.cameras[k].status;
    if (!missing.ok()) notes.push_back(outcome.NameOf(k) + ": " + missing.message());
  }
  SetNotes(notes, *report);
  return report;
}

dds::Message<idl::palpate_msgs::PerceptionReport> ToReportOf(const FrameOutcome& outcome,
                                                             std::size_t camera,
                                                             const std::string& depth_frame) {
  auto report = ReportWithoutNotes(outcome, camera, depth_frame);
  SetNotes(outcome.observation.views[camera].frame.notes, *report);
  return report;
}

dds::JoinedCloud JoinedRobotCloud(const FrameOutcome& outcome) {
  return Joined(outcome, &SegmentedFrame::robot);
}

dds::JoinedCloud JoinedObjectCloud(const FrameOutcome& outcome) {
  return Joined(outcome, &SegmentedFrame::object);
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
