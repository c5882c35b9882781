// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "components/capture/frame_source.hpp"
#include "components/capture/node/frame_publisher.hpp"
#include "components/capture/node/node_config.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::capture {

/// Publishes what a frame source gives. Three threads: the source's own, one that writes, and the
/// caller's, which reports. Between source and writer stands the source's bounded queue.
class CaptureNode {
 public:
  /// Throws RunError where DDS refuses.
  CaptureNode(const NodeConfig& config, std::unique_ptr<FrameSource> source, int domain_id,
              dds::TopicTable table, dds::NodeLog::ProcessLog process_log);
  ~CaptureNode();

  /// Until Stop(), or the end of a recording. Throws RunError where no frame of it could be read.
  void Run();
  /// From any thread.
  void Stop();

 private:
  using Clock = dds::WaitSet::Clock;

  void PublishFrames();
  void PublishOne(const SourceFrame& frame);
  void WatchSource();
  void LogChange(const SourceHealth& health);
  void RemindOfCamera(const SourceHealth& health, bool changed);
  void Report(const SourceHealth& health);

  bool step_;
  bool wait_for_reader_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  FramePublisher publisher_;
  std::unique_ptr<FrameSource> source_;
  std::mutex mutex_;
  dds::HealthCounts counts_;  ///< by the writing thread
  std::string last_words_;    ///< state and reason, logged when they change
  std::vector<std::string> last_notes_;
  Clock::time_point next_report_;
  Clock::time_point waits_since_;  ///< for the camera
  Clock::time_point next_reminder_;
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace palpate::capture
