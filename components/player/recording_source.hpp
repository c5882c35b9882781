// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/player/offered_qos.hpp"
#include "libs/recording/reader.hpp"
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
  std::int64_t start_ns() const { return start_ns_; }  ///< time of the first message
  std::int64_t end_ns() const { return end_ns_; }      ///< and of the last

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
  /// One file.
  struct Part {
    std::unique_ptr<recording::Reader> reader;
    std::vector<std::optional<std::size_t>> topic_of_channel;  ///< by id
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;
  };
  /// A file that is being read.
  struct Active {
    std::size_t part = 0;
    std::optional<recording::MessageStream> stream;
    const recording::Message* head = nullptr;
  };

  void AddPart(const std::filesystem::path& file, const recording::TopicChoice& choice);
  std::optional<std::size_t> TopicOf(const recording::Reader& reader,
                                     const recording::Channel& channel,
                                     const recording::TopicChoice& choice);
  recording::MessageFilter FilterOf(const Part& part) const;
  void Activate();
  bool IsRepeated(const Active& active, const PlayedMessage& message);

  std::vector<Part> parts_;  ///< in the order of their beginnings
  std::vector<PlayedTopic> topics_;
  std::vector<std::string> problems_;
  std::int64_t start_ns_ = 0;
  std::int64_t end_ns_ = 0;

  std::int64_t sought_ns_ = 0;
  std::size_t next_part_ = 0;
  std::vector<Active> active_;
  std::optional<std::size_t> advance_;  ///< of active_, before the next message is chosen
  PlayedMessage current_;
  std::map<std::size_t, std::string> last_latched_;  ///< by topic
};

/// "rt/forces" -> "/forces"; other names stay.
std::string PlayedName(const std::string& topic);

}  // namespace palpate::player
