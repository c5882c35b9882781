// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/player/recording_source.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/publications.hpp"

namespace palpate::player {

/// A writer for each topic of a recording. A topic that a live writer publishes is never mixed with
/// it.
class PlayedWriters {
 public:
  /// `on_change` is called from DDS's threads when readers come or go. Throws RunError where DDS
  /// refuses.
  PlayedWriters(dds::Participant& participant, dds::NodeLog& log,
                const std::vector<PlayedTopic>& topics, const std::function<void()>& on_change);

  /// Sends, unless the topic is silent. False where DDS does not take it.
  [[nodiscard]] bool Write(std::size_t topic, std::string_view cdr);
  [[nodiscard]] bool WaitUntilReceived(std::chrono::nanoseconds at_most);
  /// After the first message of a topic: waits until its reliable readers have it, or so long.
  /// False where it did not wait, because no reader confirms or the message was not the first.
  bool ConfirmFirst(std::size_t topic, std::chrono::nanoseconds at_most);

  /// Of topics that are not silent.
  std::uint32_t readers() const;
  std::uint32_t readers(std::size_t topic) const { return channels_[topic].writer->matched(); }
  /// Rises with each reader that appears, on any topic.
  std::uint64_t readers_ever() const;

  /// For a wait set: Update() takes what it has.
  dds_entity_t live_writers() const { return publications_.reader(); }
  /// True where live writers have come or gone.
  bool Update() { return publications_.Update(); }
  std::size_t live_count() const { return publications_.all().size(); }

  /// Silences what live writers publish, too: topics that every node has, and, where `answering`
  /// names a topic, all of the process that publishes it. Throws RunError for others.
  void RefuseLiveTopics(const std::string& answering);
  /// Silences the topics of writers that have come since, and warns.
  void SilenceNewLiveTopics();

 private:
  struct Channel {
    std::string name;  ///< in the recording
    std::string dds_topic;
    std::unique_ptr<dds::RawWriter> writer;
    bool is_silent = false;
    bool is_confirmed = false;  ///< its first message
  };

  dds::NodeLog& log_;
  std::vector<Channel> channels_;
  dds::Publications publications_;
};

}  // namespace palpate::player
