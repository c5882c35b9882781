// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/shape_source.hpp"

#include <algorithm>
#include <utility>

#include "components/force_estimation/node/convert.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/depth_picture.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::force_estimation {

namespace {

constexpr double kNsPerSecond = 1e9;

}  // namespace

ShapeSource::ShapeSource(dds::Participant& participant, dds::WaitSet& loop,
                         const std::optional<Eigen::Isometry3d>& T_robot_camera, FrameEvents events)
    : FrameSource(std::move(events)),
      T_robot_camera_(T_robot_camera),
      clouds_(participant.CreateReader(dds::kRobotCloudTopic)),
      reports_(participant.CreateReader(dds::kPerceptionReportTopic)),
      contacts_(participant.CreateReader(dds::kContactsTopic)) {
  loop.Attach(clouds_, [this] { TakeClouds(); });
  loop.Attach(reports_, [this] { TakeReports(); });
  loop.Attach(contacts_, [this] { TakeContacts(); });
}

/// Parts of frames that are not whole yet were seen from the old place.
void ShapeSource::SetCalibration(const robot::CalibrationFile& calibration) {
  if (!calibration.pose) return;
  T_robot_camera_ = calibration.pose->T_robot_camera;
  depth_bias_ = calibration.depth_bias;
  dropped_ += pending_.size();
  pending_.clear();
}

/// nullptr for the parts of a frame that was passed on already.
ShapeSource::Parts* ShapeSource::PartsAt(int64_t stamp_ns) {
  if (last_ && stamp_ns == last_->stamp_ns) return nullptr;
  const auto found = std::find_if(pending_.begin(), pending_.end(),
                                  [&](const Parts& parts) { return parts.stamp_ns == stamp_ns; });
  if (found != pending_.end()) return &*found;
  if (pending_.size() == kMostPending) {
    pending_.pop_front();
    ++dropped_;
  }
  pending_.emplace_back().stamp_ns = stamp_ns;
  return &pending_.back();
}

void ShapeSource::TakeClouds() {
  for (const auto& message : clouds_.Take()) {
    Parts* parts = PartsAt(dds::StampNs(message.header.stamp));
    if (!parts) continue;
    Status status = dds::CheckFrameId(message.header, geometry::kCameraDepthOpticalFrame);
    if (status.ok()) status = dds::FromPointCloud2(message, &parts->cloud.emplace());
    if (!status.ok()) {
      parts->cloud.emplace();
      parts->status = {status.code(), "/perception/robot_cloud: " + status.message()};
    }
  }
  PassOn();
}

void ShapeSource::TakeReports() {
  for (const auto& message : reports_.Take()) {
    const int64_t stamp_ns = dds::StampNs(message.header.stamp);
    Parts* parts = PartsAt(stamp_ns);
    if (!parts) continue;
    parts->report = Report{{stamp_ns, message.epoch, std::string(dds::Text(message.device)),
                            dds::ToPicture(message.picture)},
                           message.frame_counter,
                           StatusOfPerception(message)};
  }
  PassOn();
}

void ShapeSource::TakeContacts() {
  for (const auto& message : contacts_.Take()) {
    Parts* parts = PartsAt(dds::StampNs(message.header.stamp));
    if (!parts) {
      events().repeated(last_head_);
      continue;
    }
    Status status = dds::CheckFrameId(message.header, geometry::kCameraDepthOpticalFrame);
    if (status.ok()) {
      status = FromContactArray(message, T_robot_camera_.value_or(Eigen::Isometry3d::Identity()),
                                &parts->contacts.emplace());
    }
    if (!status.ok()) {
      parts->contacts.emplace();
      parts->status = {status.code(), "/perception/contacts: " + status.message()};
    }
  }
  PassOn();
}

/// Whole frames, in the order of their coming. Those before one that is whole lost a part.
void ShapeSource::PassOn() {
  for (size_t i = 0; i < pending_.size(); ++i) {
    Parts& parts = pending_[i];
    if (!parts.cloud || !parts.report || !parts.contacts) continue;
    Parts whole = std::move(parts);
    dropped_ += i;
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    Accept(std::move(whole));
    i = static_cast<size_t>(-1);
  }
}

void ShapeSource::Accept(Parts parts) {
  events().came();
  const Report& report = *parts.report;
  Judge(report.origin);
  last_head_ = {parts.stamp_ns, report.frame_counter, report.origin.device,
                dds::WaitSet::Clock::now()};
  if (!parts.status.ok()) return events().refused(last_head_, parts.status);
  if (!T_robot_camera_) {
    return events().refused(
        last_head_, {StatusCode::kNoCalibration,
                     "where the camera stands is not known: no camera_pose is set, and nothing has "
                     "come on /calibration"});
  }
  if (depth_bias_ && report.perception.ok()) {
    const Status status = robot::CheckDepthPicture(*depth_bias_, report.origin.picture);
    if (!status.ok()) return events().refused(last_head_, status);
  }
  FrameInput input;
  input.head = last_head_;
  auto& shape = input.frame.emplace<PerceivedShape>();
  shape.perception = report.perception;
  ShapeFrame& frame = shape.frame;
  frame.t_s = static_cast<double>(parts.stamp_ns) / kNsPerSecond;
  frame.cloud = std::move(*parts.cloud);
  frame.T_robot_camera = *T_robot_camera_;
  frame.epoch = report.origin.epoch;
  frame.contacts = std::move(*parts.contacts);
  events().accepted(std::move(input));
}

/// Another camera, or one that was started again from the beginning, has nothing to do with what
/// was learnt before; one that was only opened anew (its epoch rose) has.
void ShapeSource::Judge(const Origin& origin) {
  const bool back = last_ && origin.stamp_ns <= last_->stamp_ns;
  const bool anew =
      !last_ || origin.device != last_->device || (back && origin.epoch <= last_->epoch);
  if (back || anew) events().sequence(back, anew);
  last_ = origin;
}

}  // namespace palpate::force_estimation
