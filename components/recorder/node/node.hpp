// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "components/recorder/config.hpp"
#include "components/recorder/node/recorded_topic.hpp"
#include "components/recorder/recording_thread.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/publications.hpp"
#include "libs/dds/wait_set.hpp"
#include "libs/recording/topic_choice.hpp"

namespace palpate::recorder {

using NodeConfig = dds::WithNodeSettings<Config>;

/// What is recorded, and where it goes.
struct RecordPlan {
  std::filesystem::path file;  ///< "run.mcap"; snapshots are named after it
  bool only_recent = false;    ///< no file but snapshots
  recording::TopicChoice choice;
  FileExtras extras;
  double duration_s = 0.0;  ///< ends then; 0: at Stop()
  /// Is given the state once a second, and at the end; may be empty.
  std::function<void(const RecorderStatus&)> show;
};

/// Records the topics of a domain, whatever their types.
class RecorderNode {
 public:
  /// Throws InputError for bad settings, RunError where DDS refuses or the file cannot be begun.
  RecorderNode(const NodeConfig& config, RecordPlan plan, int domain_id, dds::TopicTable table,
               dds::NodeLog::ProcessLog process_log);

  /// Records until Stop(), the duration, or an error. Throws RunError where the recording is not
  /// complete; what is in the file can be read.
  void Run();
  /// From any thread.
  void Stop() { loop_.Stop(); }
  /// Saves the last seconds. From any thread and from a signal handler.
  void RequestSnapshot() { snapshot_requested_ = true; }

  /// With mean rates. From the thread of Run() only.
  RecorderStatus Status() const;
  RecordingThread::State files() const { return thread_.state(); }

 private:
  using TopicAndType = std::pair<std::string, std::string>;

  bool IsChosen(const dds::Publication& publication) const;
  void UpdateTopics();
  void Follow(const dds::Publication& publication);
  void TakeDiagnostics();
  void Save(const std::string& kind, const std::string& reason);
  RecorderStatus Totals() const;
  void LookAfter();
  void Report();

  NodeConfig config_;
  RecordPlan plan_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  dds::Reader<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
  dds::Publications publications_;
  RecordingThread thread_;
  std::map<TopicAndType, std::unique_ptr<RecordedTopic>> topics_;  ///< its threads use thread_
  std::set<std::string> in_error_;                                 ///< names on /diagnostics
  std::optional<dds::WaitSet::Clock::time_point> last_error_saved_;
  std::size_t snapshots_told_ = 0;
  dds::WaitSet::Clock::time_point start_;
  std::atomic<bool> snapshot_requested_ = false;
};

}  // namespace palpate::recorder
