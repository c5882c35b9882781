// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/node/node.hpp"

#include <cmath>
#include <utility>

#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"

namespace palpate::motion_capture {

namespace {

constexpr auto kReportPeriod = std::chrono::seconds(1);

}  // namespace

MotionCaptureNode::MotionCaptureNode(const NodeConfig& config,
                                     const Eigen::Isometry3d& T_robot_mocap,
                                     const geometry::PoseStandardError& pose_error, int domain_id,
                                     dds::TopicTable table, dds::NodeLog::ProcessLog process_log)
    : config_(config),
      version_(ParseNatNetVersion(config.natnet_version)),
      map_(T_robot_mocap, config.rename, config.unlabelled),
      pose_error_(pose_error),
      participant_(dds::ParticipantOf(config.dds, "palpate_motion_capture", domain_id),
                   std::move(table)),
      loop_(participant_),
      log_(participant_, std::move(process_log)),
      health_(participant_, "motion_capture", Clock::now()),
      markers_(participant_.CreateWriter(dds::kMarkersTopic)),
      receiver_(config.interface_address, config.multicast_group, config.port,
                [this](std::vector<std::uint8_t> bytes) { Keep(std::move(bytes)); }) {
  loop_.OnWake([this] { PublishFrames(); });
  loop_.Every(kReportPeriod, [this] { ReportHealth(); });
  log_.Write(
      Severity::kInfo,
      "waiting for NatNet frames on UDP port " + std::to_string(config.port) +
          (config.multicast_group.empty() ? std::string() : " of group " + config.multicast_group));
}

void MotionCaptureNode::Keep(std::vector<std::uint8_t> bytes) {
  const std::int64_t now_ns = participant_.Now_ns();
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() == kMostWaiting) {
      ++overflowed_;
      return;
    }
    waiting_.push_back({std::move(bytes), now_ns});
  }
  loop_.Wake();
}

void MotionCaptureNode::PublishFrames() {
  std::vector<Datagram> datagrams;
  {
    const std::lock_guard lock(mutex_);
    datagrams.swap(waiting_);
    counts_.dropped += std::exchange(overflowed_, 0);
  }
  for (const Datagram& datagram : datagrams) {
    if (!IsNatNetFrame(datagram.bytes.data(), datagram.bytes.size())) continue;
    ++counts_.received;
    last_frame_ = Clock::now();
    NatNetFrame frame;
    last_status_ = ParseNatNetFrame(datagram.bytes.data(), datagram.bytes.size(), version_, &frame);
    if (last_status_.ok()) {
      const auto latency_ns = static_cast<std::int64_t>(std::llround(1e9 * config_.latency_s));
      Publish(frame, datagram.received_ns - latency_ns);
    } else {
      ++counts_.refused;
      log_.WarnRepeatedly("frame refused: " + last_status_.message());
    }
  }
}

void MotionCaptureNode::Publish(const NatNetFrame& frame, std::int64_t stamp_ns) {
  const std::vector<CapturedMarker> markers = map_.Map(frame);
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, stamp_ns, geometry::kRobotFrame);
  message->counter = counter_++;
  dds::SetVector(message->pose_about_m, map_.origin_m());
  message->pose_translation_sigma_m = pose_error_.translation_m;
  message->pose_rotation_sigma_rad = pose_error_.rotation_rad;
  dds::Resize(message->markers, markers.size());
  for (std::size_t i = 0; i < markers.size(); ++i) {
    auto& target = message->markers._buffer[i];
    dds::SetText(target.name, markers[i].name);
    dds::SetVector(target.sigma_m, Eigen::Vector3d::Constant(config_.sigma_m));
    target.valid = markers[i].position_m.has_value();
    if (target.valid) dds::SetVector(target.position_m, *markers[i].position_m);
  }
  ++(markers_.Write(message) ? counts_.published : counts_.dropped);
}

void MotionCaptureNode::ReportHealth() {
  health_.Report(CurrentStatus(), counts_,
                 {{"readers_of_markers", std::to_string(markers_.matched())}}, Clock::now());
  log_.WriteCounted();
}

Status MotionCaptureNode::CurrentStatus() const {
  if (counts_.received > 0 && SecondsSince(last_frame_) > config_.silence_s) {
    return {StatusCode::kStale, "no frame of motion capture for " +
                                    FormatNumber(std::round(SecondsSince(last_frame_))) + " s"};
  }
  return last_status_;
}

}  // namespace palpate::motion_capture
