// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/recording_source.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::player {

namespace {

using recording::Channel;
using recording::Message;
using recording::Schema;

constexpr std::string_view kLog = "/rosout";

/// Why a channel cannot be played; empty: it can.
std::string WhyNot(const Channel& channel, const Schema& schema) {
  if (channel.message_encoding != "cdr") {
    return "its messages are '" + channel.message_encoding +
           "', only cdr (ROS 2, DDS) can be played";
  }
  return schema.name.empty() ? "the recording does not name its type" : "";
}

/// Whether the type has a key: as the recorder says, or "@key" in the last struct of its IDL, which
/// is the outermost.
bool HasKey(const Channel& channel, const Schema& schema) {
  if (channel.metadata.contains("has_key")) return channel.metadata.at("has_key") == "true";
  if (schema.encoding != "omgidl") return false;
  const std::size_t last = schema.data.rfind("struct ");
  return last != schema.data.npos && schema.data.find("@key", last) != schema.data.npos;
}

bool HasHeader(const Schema& schema) {
  if (schema.encoding != "ros2msg") return false;
  try {
    const auto definitions = recording::ParseRos2msg(schema.name, schema.data);
    const auto& fields = definitions.at(recording::ShortTypeName(schema.name)).fields;
    return !fields.empty() && fields.front().type == "std_msgs/Header";
  } catch (const InputError&) {
    return false;  // the definition is for other programs: CDR plays without it
  }
}

OfferedQos Strongest(const OfferedQos& a, const OfferedQos& b) {
  const bool all = a.depth == 0 || b.depth == 0;
  return {a.reliable || b.reliable, a.latched || b.latched, all ? 0 : std::max(a.depth, b.depth)};
}

}  // namespace

RecordingSource::RecordingSource(const std::vector<std::filesystem::path>& files,
                                 const recording::TopicChoice& choice)
    : recorded_(std::make_unique<recording::RecordedMessages>(files)),
      topic_of_channel_(std::size_t{1} << 16U) {
  for (const auto& file : recorded_->files()) {
    for (const std::string& problem : file->contents().problems) {
      problems_.push_back(file->path().string() + ": " + problem);
    }
    if (file->contents().statistics.message_count == 0) continue;
    const std::int64_t begin_ns = file->contents().statistics.start_time_ns;
    if (begin_ns > start_ns()) splits_ns_.insert(begin_ns);
  }
  for (const auto& [id, channel] : recorded_->contents().channels) Add(channel, choice);
  if (recorded_->contents().statistics.message_count == 0 || topics_.empty()) {
    std::string text = files.front().string() + ": nothing to play";
    for (const std::string& problem : problems_) text += "\n  " + problem;
    throw InputError(text);
  }
  Seek(start_ns());
}

void RecordingSource::Add(const Channel& channel, const recording::TopicChoice& choice) {
  const auto index = TopicOf(channel, choice);
  topic_of_channel_[channel.id] = index;
  if (!index) return;
  PlayedTopic& topic = topics_[*index];
  const auto& counts = recorded_->contents().statistics.channel_message_counts;
  const auto count = counts.find(channel.id);
  topic.messages += count == counts.end() ? 0 : count->second;
  if (!topic.first.empty()) return;
  recording::MessageFilter filter;
  filter.wanted = [&](const Channel& other) { return other.id == channel.id; };
  recording::RecordedStream stream = recorded_->Messages(filter);
  if (const Message* first = stream.Next()) topic.first = first->data.substr(0, 4);
}

std::optional<std::size_t> RecordingSource::TopicOf(const Channel& channel,
                                                    const recording::TopicChoice& choice) {
  const std::string name = recording::RosTopicName(channel.topic);
  if (recording::IsRosInternal(channel.topic) || !choice.Includes(name)) return std::nullopt;
  const Schema& schema = recorded_->SchemaOf(channel);
  if (const std::string reason = WhyNot(channel, schema); !reason.empty()) {
    problems_.push_back("channel " + name + " is not played: " + reason);
    return std::nullopt;
  }
  const auto metadata = channel.metadata.find("offered_qos_profiles");
  const std::optional<OfferedQos> qos =
      metadata == channel.metadata.end() ? std::nullopt : ParseOfferedQos(metadata->second);
  auto known = std::find_if(topics_.begin(), topics_.end(), [&](const PlayedTopic& topic) {
    return topic.name == name && topic.type == schema.name;
  });
  if (known == topics_.end()) {
    PlayedTopic topic;
    topic.name = name;
    topic.type = schema.name;
    topic.qos = qos;
    topic.has_key = HasKey(channel, schema);
    topic.has_header = HasHeader(schema);
    known = topics_.insert(topics_.end(), std::move(topic));
  } else if (qos) {
    known->qos = known->qos ? Strongest(*known->qos, *qos) : *qos;
  }
  return static_cast<std::size_t>(known - topics_.begin());
}

recording::MessageFilter RecordingSource::FilterOf(
    const std::function<bool(const PlayedTopic&)>& wanted) const {
  std::vector<bool> channels(topic_of_channel_.size());
  for (std::size_t id = 0; id < channels.size(); ++id) {
    const auto topic = topic_of_channel_[id];
    channels[id] = topic && (!wanted || wanted(topics_[*topic]));
  }
  recording::MessageFilter filter;
  filter.wanted = [channels = std::move(channels)](const Channel& channel) {
    return static_cast<bool>(channels[channel.id]);
  };
  return filter;
}

void RecordingSource::Seek(std::int64_t time_ns) {
  recording::MessageFilter filter = FilterOf();
  filter.start_time_ns = time_ns;
  messages_ = std::make_unique<recording::ReadAhead>(recorded_->Messages(filter));
  last_latched_.clear();
}

PlayedMessage RecordingSource::Played(const Message& message) const {
  return {topic_of_channel_[message.channel_id].value_or(0), message.log_time_ns, message.data};
}

/// Where the recorder splits a run, each file begins with the last message of every latched topic.
bool RecordingSource::IsRepeated(const PlayedMessage& message, LastMessages* last) const {
  if (!topics_[message.topic].is_latched()) return false;
  std::string& before = (*last)[message.topic];
  const bool again = splits_ns_.contains(message.time_ns) && message.data == before;
  before = message.data;
  return again;
}

const PlayedMessage* RecordingSource::Next() {
  while (const Message* message = messages_->Next()) {
    current_ = Played(*message);
    if (!IsRepeated(current_, &last_latched_)) return &current_;
  }
  return nullptr;
}

std::vector<RecordingSource::Latched> RecordingSource::LatchedBefore(std::int64_t time_ns) const {
  struct Found {
    std::int64_t time_ns;
    Latched message;
  };
  std::vector<Found> found;
  const auto add = [&](const PlayedMessage& message) {
    found.push_back({message.time_ns, {message.topic, std::string(message.data)}});
  };
  const auto is_latched = [](const PlayedTopic& topic) {
    return topic.is_latched() && topic.name != kLog;
  };
  const auto newest_suffices = [](const PlayedTopic& topic) {
    return topic.qos->depth == 1 && !topic.has_key;
  };
  const auto newest =
      recorded_->NewestBefore(time_ns - 1, FilterOf([&](const PlayedTopic& topic) {
                                             return is_latched(topic) && newest_suffices(topic);
                                           }).wanted);
  for (const recording::StoredMessage& stored : newest) {
    add({*topic_of_channel_[stored.message.channel_id], stored.message.log_time_ns, stored.data});
  }
  recording::MessageFilter others = FilterOf(
      [&](const PlayedTopic& topic) { return is_latched(topic) && !newest_suffices(topic); });
  others.end_time_ns = time_ns - 1;
  LastMessages last;
  recording::RecordedStream stream = recorded_->Messages(others);
  while (const Message* message = stream.Next()) {
    const PlayedMessage played = Played(*message);
    if (!IsRepeated(played, &last)) add(played);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.time_ns < b.time_ns; });
  std::vector<std::size_t> later(topics_.size());  // messages of each topic behind this one
  std::vector<Latched> messages;
  for (auto one = found.rbegin(); one != found.rend(); ++one) {
    const PlayedTopic& topic = topics_[one->message.topic];
    const bool all = topic.has_key || topic.qos->depth == 0;
    const std::size_t behind = later[one->message.topic]++;
    if (all || behind < static_cast<std::size_t>(topic.qos->depth)) {
      messages.push_back(std::move(one->message));
    }
  }
  std::reverse(messages.begin(), messages.end());
  return messages;
}

}  // namespace palpate::player
