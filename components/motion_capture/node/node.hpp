// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "components/motion_capture/captured_markers.hpp"
#include "components/motion_capture/node/node_config.hpp"
#include "components/motion_capture/node/udp_receiver.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::motion_capture {

/// Publishes the frames of a motion-capture server as /perception/markers, in the robot frame.
class MotionCaptureNode {
 public:
  /// Throws InputError for bad settings, RunError where DDS or the network refuses.
  /// `pose_error`: of T_robot_mocap.
  MotionCaptureNode(const NodeConfig& config, const Eigen::Isometry3d& T_robot_mocap,
                    const geometry::PoseStandardError& pose_error, int domain_id,
                    dds::TopicTable table, dds::NodeLog::ProcessLog process_log);

  /// Returns after Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

 private:
  using Clock = dds::WaitSet::Clock;
  struct Datagram {
    std::vector<std::uint8_t> bytes;
    std::int64_t received_ns = 0;
  };

  void Keep(std::vector<std::uint8_t> bytes);
  void PublishFrames();
  void Publish(const NatNetFrame& frame, std::int64_t stamp_ns);
  void ReportHealth();
  Status CurrentStatus() const;

  static constexpr std::size_t kMostWaiting = 1000;

  NodeConfig config_;
  NatNetVersion version_;
  MarkerMap map_;
  geometry::PoseStandardError pose_error_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  dds::Writer<idl::palpate_msgs::MarkerArray3> markers_;
  dds::HealthCounts counts_;
  Status last_status_{StatusCode::kNotRun, "no frame of motion capture yet"};
  Clock::time_point last_frame_;
  std::uint64_t counter_ = 0;
  std::mutex mutex_;
  std::vector<Datagram> waiting_;
  std::uint64_t overflowed_ = 0;
  UdpReceiver receiver_;  // goes first: its thread uses the others
};

}  // namespace palpate::motion_capture
