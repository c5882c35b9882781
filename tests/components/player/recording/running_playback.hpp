// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "components/player/node/recording_node.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/raw_reader.hpp"
#include "tests/components/player/recording/sample_recording.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::player {

using PlayerConfig = dds::WithNodeSettings<Config>;

/// A player of MCAP files in a thread of its own.
class RunningPlayback {
 public:
  RunningPlayback(const std::vector<std::filesystem::path>& files, RecordingPlan plan,
                  const PlayerConfig& config = {})
      : node_(config, std::move(plan), RecordingSource(files, {}),
              static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {}),
        thread_([this] { Run(); }) {}
  ~RunningPlayback() {
    node_.Stop();
    Join();
  }

  RecordingNode& node() { return node_; }
  bool finished() const { return finished_; }
  /// Waits for its end. Returns the error of Run(), or "".
  std::string Join() {
    if (thread_.joinable()) thread_.join();
    return error_;
  }

 private:
  void Run() {
    try {
      node_.Run();
    } catch (const RunError& error) {
      error_ = error.what();
    }
    finished_ = true;
  }

  RecordingNode node_;
  std::string error_;
  std::atomic<bool> finished_ = false;
  std::thread thread_;
};

/// Hears texts on a topic.
class TextListener {
 public:
  TextListener(dds::TestNode& node, const std::string& ros_topic, bool latched = false)
      : reader_(
            node.participant.handle(),
            {.dds_topic = "rt" + ros_topic,
             .dds_type = "std_msgs::msg::dds_::String_",
             .reliability = dds::Reliability::kReliable,
             .durability = latched ? dds::Durability::kTransientLocal : dds::Durability::kVolatile},
            [this, &node](dds::RawMessage message) {
              const std::lock_guard lock(mutex_);
              texts_.push_back(TextOfCdr(message.cdr()));
              node.loop.Wake();
            }) {}

  std::vector<std::string> texts() const {
    const std::lock_guard lock(mutex_);
    return texts_;
  }
  std::uint32_t writers() const { return reader_.matched(); }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> texts_;
  dds::RawReader reader_;
};

}  // namespace palpate::player
