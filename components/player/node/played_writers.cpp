// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/played_writers.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::player {

namespace {

/// Of topics that keep all, and of those of which nothing is known.
constexpr int kManyMessages = 1000;
constexpr int kUsualDepth = 10;

/// Every node publishes these about itself.
const std::set<std::string_view> kOfEveryNode{"/rosout", "/diagnostics", "/component_status",
                                              "/parameter_events"};

std::string DdsTypeOf(const std::string& type) {
  if (type.find("::") != type.npos) return type;
  const std::size_t slash = type.find('/');
  if (slash == type.npos) return type;
  const bool is_short = type.find("/msg/") == type.npos;
  return dds::DdsTypeName(is_short ? type.substr(0, slash) + "/msg" + type.substr(slash) : type);
}

dds::RawWriterTopic WriterOf(const PlayedTopic& topic, const std::string& dds_topic,
                             const dds::TopicTable& table) {
  dds::RawWriterTopic writer;
  writer.dds_topic = dds_topic;
  writer.dds_type = DdsTypeOf(topic.type);
  writer.has_key = topic.has_key;
  writer.is_xcdr2 = dds::IsXcdr2(topic.first);
  writer.depth = kUsualDepth;
  if (topic.qos) {
    writer.reliability =
        topic.qos->reliable ? dds::Reliability::kReliable : dds::Reliability::kBestEffort;
    writer.durability =
        topic.qos->latched ? dds::Durability::kTransientLocal : dds::Durability::kVolatile;
    writer.depth = topic.qos->depth == 0 ? kManyMessages : topic.qos->depth;
  } else if (dds::IsRosTopicName(topic.name)) {
    const dds::TopicSettings& row = table.At(topic.name);
    writer.reliability = row.reliability;
    writer.durability = row.durability;
    writer.depth = row.depth;
  }
  // What a latched topic keeps decides what late joiners get; others only wait for slow readers.
  if (writer.durability == dds::Durability::kVolatile) {
    writer.depth = std::max(writer.depth, kUsualDepth);
  }
  return writer;
}

std::array<std::uint8_t, 12> ProcessOf(const dds::Publication& publication) {
  std::array<std::uint8_t, 12> prefix{};
  std::copy_n(publication.guid.begin(), prefix.size(), prefix.begin());
  return prefix;
}

}  // namespace

PlayedWriters::PlayedWriters(dds::Participant& participant, dds::NodeLog& log,
                             const std::vector<PlayedTopic>& topics,
                             const std::function<void()>& on_change)
    : log_(log), publications_(participant.handle(), [](const std::string&) { return false; }) {
  for (const PlayedTopic& topic : topics) {
    Channel channel;
    channel.name = topic.name;
    channel.dds_topic = dds::IsRosTopicName(topic.name)
                            ? dds::DdsTopicName(participant.ResolvedName(topic.name))
                            : topic.name;
    channel.writer = participant.CreateRawWriter(
        WriterOf(topic, channel.dds_topic, participant.table()), on_change);
    channels_.push_back(std::move(channel));
  }
}

bool PlayedWriters::Write(std::size_t topic, std::string_view cdr) {
  return channels_[topic].is_silent || channels_[topic].writer->Write(cdr);
}

bool PlayedWriters::WaitUntilReceived(std::chrono::nanoseconds at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  bool all = true;
  for (Channel& channel : channels_) {
    const auto left = std::max<std::chrono::nanoseconds>(std::chrono::nanoseconds(0),
                                                         end - std::chrono::steady_clock::now());
    all = channel.writer->WaitUntilReceived(left) && all;
  }
  return all;
}

bool PlayedWriters::ConfirmFirst(std::size_t topic, std::chrono::nanoseconds at_most) {
  Channel& channel = channels_[topic];
  const bool waits = !channel.is_confirmed && !channel.is_silent && channel.writer->matched() > 0;
  channel.is_confirmed = true;
  // The message is sent: a reader that does not answer in time is a slow one.
  if (waits) static_cast<void>(channel.writer->WaitUntilReceived(at_most));
  return waits;
}

std::uint32_t PlayedWriters::readers() const {
  std::uint32_t readers = 0;
  for (const Channel& channel : channels_) {
    if (!channel.is_silent) readers += channel.writer->matched();
  }
  return readers;
}

std::uint64_t PlayedWriters::readers_ever() const {
  std::uint64_t readers = 0;
  for (const Channel& channel : channels_) readers += channel.writer->matched_ever();
  return readers;
}

void PlayedWriters::RefuseLiveTopics(const std::string& answering) {
  std::set<std::array<std::uint8_t, 12>> answerers;
  std::set<std::string> live;
  for (const auto& [guid, publication] : publications_.all()) {
    live.insert(publication.dds_topic);
    if (publication.dds_topic == answering) answerers.insert(ProcessOf(publication));
  }
  std::set<std::string> answered;
  for (const auto& [guid, publication] : publications_.all()) {
    if (answerers.contains(ProcessOf(publication))) answered.insert(publication.dds_topic);
  }
  std::vector<std::string> silenced;
  std::string refused;
  for (Channel& channel : channels_) {
    if (channel.is_silent || !live.contains(channel.dds_topic)) continue;
    if (kOfEveryNode.contains(channel.name) || answered.contains(channel.dds_topic)) {
      channel.is_silent = true;
      silenced.push_back(channel.name);
    } else {
      refused += " --exclude " + channel.name;
    }
  }
  if (!refused.empty()) {
    throw RunError(
        "live writers of this domain publish topics of the recording; leave these out (" +
        refused.substr(1) +
        "), rename them (--remap), play in another domain (--domain), or mix them "
        "(--beside-writers)");
  }
  if (silenced.empty()) return;
  log_.Write(Severity::kInfo, "not played, because live writers publish them: " + Listed(silenced));
}

void PlayedWriters::SilenceNewLiveTopics() {
  std::set<std::string> live;
  for (const auto& [guid, publication] : publications_.all()) live.insert(publication.dds_topic);
  for (Channel& channel : channels_) {
    if (channel.is_silent || !live.contains(channel.dds_topic)) continue;
    channel.is_silent = true;
    const bool expected = kOfEveryNode.contains(channel.name);
    log_.Write(
        expected ? Severity::kInfo : Severity::kWarning,
        channel.name + ": a live writer appeared; no longer played (--beside-writers mixes)");
  }
}

}  // namespace palpate::player
