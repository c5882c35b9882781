// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/recording_source.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"

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

std::string PlayedName(const std::string& topic) {
  return topic.starts_with("rt/") ? topic.substr(2) : topic;
}

RecordingSource::RecordingSource(const std::vector<std::filesystem::path>& files,
                                 const recording::TopicChoice& choice) {
  for (const std::filesystem::path& file : files) AddPart(file, choice);
  std::sort(parts_.begin(), parts_.end(),
            [](const Part& a, const Part& b) { return a.start_ns < b.start_ns; });
  if (parts_.empty() || topics_.empty()) {
    std::string text = files.empty() ? "no recording" : files.front().string();
    text += ": nothing to play";
    for (const std::string& problem : problems_) text += "\n  " + problem;
    throw InputError(text);
  }
  start_ns_ = parts_.front().start_ns;
  end_ns_ = parts_.front().end_ns;
  for (const Part& part : parts_) end_ns_ = std::max(end_ns_, part.end_ns);
  Seek(start_ns_);
}

void RecordingSource::AddPart(const std::filesystem::path& file,
                              const recording::TopicChoice& choice) {
  Part part;
  part.reader = std::make_unique<recording::Reader>(file);
  const recording::Contents& contents = part.reader->contents();
  for (const std::string& problem : contents.problems) {
    problems_.push_back(file.string() + ": " + problem);
  }
  part.topic_of_channel.resize(std::size_t{1} << 16U);
  for (const auto& [id, channel] : contents.channels) {
    const auto topic = TopicOf(*part.reader, channel, choice);
    part.topic_of_channel[id] = topic;
    if (!topic) continue;
    const auto& counts = contents.statistics.channel_message_counts;
    const auto count = counts.find(id);
    topics_[*topic].messages += count == counts.end() ? 0 : count->second;
    if (!topics_[*topic].first.empty()) continue;
    recording::MessageFilter filter;
    filter.wanted = [&](const Channel& other) { return other.id == channel.id; };
    recording::MessageStream stream = part.reader->Messages(filter);
    if (const Message* first = stream.Next()) topics_[*topic].first = first->data.substr(0, 4);
  }
  if (contents.statistics.message_count == 0) return;
  part.start_ns = contents.statistics.start_time_ns;
  part.end_ns = contents.statistics.end_time_ns;
  parts_.push_back(std::move(part));
}

std::optional<std::size_t> RecordingSource::TopicOf(const recording::Reader& reader,
                                                    const Channel& channel,
                                                    const recording::TopicChoice& choice) {
  const std::string name = PlayedName(channel.topic);
  if (recording::IsRosInternal(channel.topic) || !choice.Includes(name)) return std::nullopt;
  const Schema& schema = reader.SchemaOf(channel);
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

recording::MessageFilter RecordingSource::FilterOf(const Part& part) const {
  recording::MessageFilter filter;
  filter.wanted = [&part](const Channel& channel) {
    return part.topic_of_channel[channel.id].has_value();
  };
  return filter;
}

void RecordingSource::Seek(std::int64_t time_ns) {
  active_.clear();
  advance_.reset();
  last_latched_.clear();
  sought_ns_ = time_ns;
  next_part_ = 0;
  while (next_part_ < parts_.size() && parts_[next_part_].end_ns < time_ns) ++next_part_;
}

void RecordingSource::Activate() {
  const Part& part = parts_[next_part_];
  recording::MessageFilter filter = FilterOf(part);
  filter.start_time_ns = sought_ns_;
  Active active{next_part_, part.reader->Messages(filter), nullptr};
  ++next_part_;
  active.head = active.stream->Next();
  if (active.head != nullptr) active_.push_back(std::move(active));
}

/// Where a recording is split, each file begins with the last message of every latched topic.
bool RecordingSource::IsRepeated(const Active& active, const PlayedMessage& message) {
  if (!topics_[message.topic].is_latched()) return false;
  std::string& last = last_latched_[message.topic];
  const bool again =
      active.part > 0 && message.time_ns <= parts_[active.part].start_ns && message.data == last;
  last = message.data;
  return again;
}

const PlayedMessage* RecordingSource::Next() {
  while (true) {
    if (advance_) {
      Active& read = active_[*advance_];
      read.head = read.stream->Next();
      if (read.head == nullptr) active_.erase(active_.begin() + static_cast<long>(*advance_));
      advance_.reset();
    }
    const auto earlier = [](const Active& a, const Active& b) {
      return a.head->log_time_ns < b.head->log_time_ns;
    };
    auto first = std::min_element(active_.begin(), active_.end(), earlier);
    while (next_part_ < parts_.size() &&
           (first == active_.end() || parts_[next_part_].start_ns <= first->head->log_time_ns)) {
      Activate();
      first = std::min_element(active_.begin(), active_.end(), earlier);
    }
    if (first == active_.end()) return nullptr;
    advance_ = static_cast<std::size_t>(first - active_.begin());
    const auto topic = parts_[first->part].topic_of_channel[first->head->channel_id];
    current_ = {topic.value_or(0), first->head->log_time_ns, first->head->data};
    if (topic && !IsRepeated(*first, current_)) return &current_;
  }
}

std::vector<RecordingSource::Latched> RecordingSource::LatchedBefore(std::int64_t time_ns) const {
  struct Kept {
    std::int64_t time_ns;
    Latched message;
  };
  std::map<std::size_t, std::deque<Kept>> kept;
  const auto keep = [&](std::size_t topic, const Message& head, std::string_view data) {
    std::deque<Kept>& own = kept[topic];
    own.push_back({head.log_time_ns, {topic, std::string(data)}});
    const PlayedTopic& played = topics_[topic];
    const bool all = played.has_key || played.qos->depth == 0;
    if (!all && own.size() > static_cast<std::size_t>(played.qos->depth)) own.pop_front();
  };
  for (const Part& part : parts_) {
    if (part.start_ns >= time_ns) continue;
    const auto is_wanted = [&](const Channel& channel, bool newest_only) {
      const auto topic = part.topic_of_channel[channel.id];
      if (!topic || !topics_[*topic].is_latched() || topics_[*topic].name == kLog) return false;
      return newest_only == (topics_[*topic].qos->depth == 1 && !topics_[*topic].has_key);
    };
    const auto newest = part.reader->NewestBefore(
        time_ns - 1, [&](const Channel& channel) { return is_wanted(channel, true); });
    for (const recording::StoredMessage& stored : newest) {
      keep(*part.topic_of_channel[stored.message.channel_id], stored.message, stored.data);
    }
    recording::MessageFilter filter;
    filter.end_time_ns = time_ns - 1;
    filter.wanted = [&](const Channel& channel) { return is_wanted(channel, false); };
    recording::MessageStream stream = part.reader->Messages(filter);
    while (const Message* message = stream.Next()) {
      keep(*part.topic_of_channel[message->channel_id], *message, message->data);
    }
  }
  std::vector<Kept> all;
  for (auto& [topic, own] : kept) std::move(own.begin(), own.end(), std::back_inserter(all));
  std::stable_sort(all.begin(), all.end(),
                   [](const Kept& a, const Kept& b) { return a.time_ns < b.time_ns; });
  std::vector<Latched> messages;
  for (Kept& one : all) messages.push_back(std::move(one.message));
  return messages;
}

}  // namespace palpate::player
