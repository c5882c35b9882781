// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/player/offered_qos.hpp"
#include "libs/recording/read_ahead.hpp"
#include "libs/recording/recorded_messages.hpp"
#include "libs/recording/topic_choice.hpp"

namespace palpate::player {

/// A topic of a recording that can be played.
struct PlayedTopic {
  std::string name;               ///< "/forces"; of a topic that is not ROS 2's, its name on DDS
  std::string type;               ///< as the schema names it: "palpate_msgs/msg/ForceArray"
  std::optional<OfferedQos> qos;  ///< nullopt: the recording does not say
  bool has_key = false;           ///< of its type
  bool has_header = false;        ///< messages begin with a std_msgs/Header
  std::string first;              ///< the first message, whose header tells the encoding
  std::uint64_t messages = 0;

  bool is_latched() const { return qos && qos->latched; }
};

struct PlayedMessage {
  std::size_t topic = 0;     ///< in RecordingSource::topics()
  std::int64_t time_ns = 0;  ///< when it was recorded
  std::string_view data;     ///< CDR
};

/// The messages of a recording, which may have many files, in the order in which they came.
class RecordingSource {
 public:
  /// Throws InputError where a file cannot be read, or nothing of it can be played.
  RecordingSource(const std::vector<std::filesystem::path>& files,
                  const recording::TopicChoice& choice);
  RecordingSource(RecordingSource&&) = default;

  const std::vector<PlayedTopic>& topics() const { return topics_; }
  /// What is not played, or is damaged, each with its reason.
  const std::vector<std::string>& problems() const { return problems_; }
  /// Time of the first message, and of the last.
  std::int64_t start_ns() const { return recorded_->contents().statistics.start_time_ns; }
  std::int64_t end_ns() const { return recorded_->contents().statistics.end_time_ns; }

  /// The next message is the first one at or after `time_ns`.
  void Seek(std::int64_t time_ns);
  /// nullptr at the end. It and its data stay until the next call of anything here.
  const PlayedMessage* Next();

  struct Latched {
    std::size_t topic = 0;
    std::string data;
  };
  /// What a reader that joined just before `time_ns` would have got of latched topics, in the order
  /// of their times: of each the last messages, of a type with key those of all instances. The log
  /// (/rosout) is left out.
  std::vector<Latched> LatchedBefore(std::int64_t time_ns) const;

 private:
  using LastMessages = std::map<std::size_t, std::string>;  ///< by topic

  void Add(const recording::Channel& channel, const recording::TopicChoice& choice);
  std::optional<std::size_t> TopicOf(const recording::Channel& channel,
                                     const recording::TopicChoice& choice);
  /// All channels that are played of topics that `wanted` names.
  recording::MessageFilter FilterOf(
      const std::function<bool(const PlayedTopic&)>& wanted = {}) const;
  bool IsRepeated(const PlayedMessage& message, LastMessages* last) const;
  PlayedMessage Played(const recording::Message& message) const;

  std::unique_ptr<const recording::RecordedMessages> recorded_;
  std::vector<std::optional<std::size_t>> topic_of_channel_;  ///< by id
  std::vector<PlayedTopic> topics_;
  std::vector<std::string> problems_;
  std::set<std::int64_t> splits_ns_;  ///< when all files but the first begin

  std::unique_ptr<recording::ReadAhead> messages_;
  PlayedMessage current_;
  LastMessages last_latched_;
};

}  // namespace palpate::player
