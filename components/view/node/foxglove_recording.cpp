// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/foxglove_recording.hpp"

#include <memory>
#include <string>

#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::view {

FoxgloveRecording::FoxgloveRecording(RecordingSource* recording, FoxgloveHub* hub)
    : recording_(recording), hub_(hub) {
  foxglove::ChannelId id = FoxgloveHub::kSceneChannel;
  for (const auto& [number, channel] : recording->recorded().contents().channels) {
    if (channel.message_encoding == "cdr") Offer(channel, ++id);
  }
  recording->PassOn(
      {.wanted = [this](const recording::Channel& channel) { return wanted_.contains(channel.id); },
       .take = [this](const recording::Message& message,
                      std::string_view data) { PassOn(message, data); }});
}

/// As the recording defines it, else as we know the type; without a definition nobody can read it.
void FoxgloveRecording::Offer(const recording::Channel& channel, foxglove::ChannelId id) {
  const recording::Schema& schema = recording_->recorded().SchemaOf(channel);
  foxglove::Channel offered{.id = id,
                            .topic = channel.topic,
                            .encoding = "cdr",
                            .schema_name = schema.name,
                            .schema = schema.data,
                            .schema_encoding = schema.encoding};
  if (schema.data.empty()) {
    const auto known = recording::FormatRos2msg(schema.name, recording::BuiltInDefinitions());
    if (!known) return;
    offered.schema = *known;
    offered.schema_encoding = "ros2msg";
  }
  hub_->AddChannel(std::move(offered), 0);
  offered_[channel.id] = id;
}

void FoxgloveRecording::SetWanted(foxglove::ChannelId channel, bool wanted) {
  for (const auto& [number, id] : offered_) {
    if (id != channel) continue;
    if (!wanted) {
      wanted_.erase(number);
    } else if (wanted_.insert(number).second) {
      recording_->WantedHasGrown(number);
    }
  }
}

void FoxgloveRecording::PassOn(const recording::Message& message, std::string_view data) {
  const auto offered = offered_.find(message.channel_id);
  if (offered == offered_.end() || !wanted_.contains(message.channel_id)) return;
  const auto bytes = std::make_shared<const std::string>(data);
  hub_->Publish(offered->second, message.log_time_ns, {bytes, *bytes});
}

}  // namespace palpate::view
