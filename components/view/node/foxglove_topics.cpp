// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/foxglove_topics.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "libs/core/error.hpp"
#include "libs/recording/ros2msg/message_definition.hpp"
#include "libs/recording/ros_names.hpp"
#include "libs/recording/topic_choice.hpp"

namespace palpate::view {

namespace {

/// Latched messages that are kept for those who subscribe later.
constexpr std::size_t kMostKept = 100;

std::optional<std::string> SchemaOf(const std::string& ros_type) {
  return recording::FormatRos2msg(ros_type, recording::BuiltInDefinitions());
}

}  // namespace

FoxgloveTopics::FoxgloveTopics(dds::Participant& participant, dds::WaitSet& loop, dds::NodeLog& log,
                               FoxgloveHub* hub)
    : participant_(participant),
      log_(log),
      hub_(hub),
      publications_(participant.handle(), [](const std::string&) { return false; }) {
  loop.Attach(publications_.reader(), [this] { Update(); });
}

void FoxgloveTopics::Update() {
  if (!publications_.Update()) return;
  std::set<TopicAndType> written;
  for (const auto& [guid, publication] : publications_.all()) {
    if (recording::IsRosInternal(publication.dds_topic)) continue;
    const TopicAndType key{publication.dds_topic, publication.dds_type};
    written.insert(key);
    const auto known = offered_.find(key);
    if (known == offered_.end()) {
      Add(key, dds::RawTopicOf(publication), publication.depth);
    } else if (dds::AskLess(publication, &known->second.topic) && known->second.reader) {
      Read(&known->second);
    }
  }
  std::erase_if(offered_, [&](const auto& one) {
    if (written.contains(one.first)) return false;
    hub_->RemoveChannel(one.second.id);
    return true;
  });
}

void FoxgloveTopics::Add(const TopicAndType& key, const dds::RawTopic& topic, std::size_t depth) {
  const std::string type = recording::RosTypeName(topic.dds_type);
  const auto schema = SchemaOf(type);
  if (!schema) return;  // nobody could read it
  const foxglove::ChannelId id = ++last_id_;
  offered_[key] = {.id = id, .topic = topic, .reader = nullptr};
  const bool latched = topic.durability == dds::Durability::kTransientLocal;
  hub_->AddChannel({.id = id,
                    .topic = recording::RosTopicName(topic.dds_topic),
                    .encoding = "cdr",
                    .schema_name = type,
                    .schema = *schema,
                    .schema_encoding = "ros2msg"},
                   latched ? std::clamp<std::size_t>(depth, 1, kMostKept) : 0);
}

void FoxgloveTopics::Read(Offered* offered) {
  offered->reader.reset();
  const auto pass_on = [hub = hub_, id = offered->id](const dds::RawMessage& message) {
    hub->Publish(id, message.source_time_ns(), {message.owner(), message.cdr()});
  };
  try {
    offered->reader =
        std::make_unique<dds::RawReader>(participant_.handle(), offered->topic, pass_on);
  } catch (const RunError& error) {
    log_.Write(Severity::kWarning, std::string("Foxglove: ") + error.what());
    hub_->TellStatus(foxglove::StatusLevel::kError, error.what());
  }
}

void FoxgloveTopics::SetWanted(foxglove::ChannelId channel, bool wanted) {
  for (auto& [key, offered] : offered_) {
    if (offered.id != channel) continue;
    if (!wanted) offered.reader.reset();
    if (wanted && !offered.reader) Read(&offered);
  }
}

}  // namespace palpate::view
