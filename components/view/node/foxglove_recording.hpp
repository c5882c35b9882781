// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string_view>

#include "components/view/node/foxglove_hub.hpp"
#include "components/view/node/recording_source.hpp"

namespace palpate::view {

/// Offers the topics of a recording to Foxglove, and passes their messages on as they were recorded
/// while somebody subscribes. From the node's thread.
class FoxgloveRecording {
 public:
  /// Both must outlive this.
  FoxgloveRecording(RecordingSource* recording, FoxgloveHub* hub);

  /// A channel gets its first subscriber, with whom its newest message is shared, or has lost its
  /// last.
  void SetWanted(foxglove::ChannelId channel, bool wanted);

 private:
  void Offer(const recording::Channel& channel, foxglove::ChannelId id);
  void PassOn(const recording::Message& message, std::string_view data);

  RecordingSource* recording_;
  FoxgloveHub* hub_;
  std::map<std::uint16_t, foxglove::ChannelId> offered_;  ///< by channel of the recording
  std::set<std::uint16_t> wanted_;
};

}  // namespace palpate::view
