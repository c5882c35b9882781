// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "components/view/node/foxglove_hub.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/publications.hpp"
#include "libs/dds/raw_reader.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::view {

/// Offers each topic of ROS that has a writer as a channel, and passes its messages on as they came
/// while somebody subscribes. From the node's thread.
class FoxgloveTopics {
 public:
  /// All must outlive this.
  FoxgloveTopics(dds::Participant& participant, dds::WaitSet& loop, dds::NodeLog& log,
                 FoxgloveHub* hub);

  /// A channel gets its first subscriber, or has lost its last.
  void SetWanted(foxglove::ChannelId channel, bool wanted);

 private:
  using TopicAndType = std::pair<std::string, std::string>;
  struct Offered {
    foxglove::ChannelId id = 0;
    dds::RawTopic topic;
    std::unique_ptr<dds::RawReader> reader;  ///< while it is wanted
  };

  void Update();
  void Add(const TopicAndType& key, const dds::RawTopic& topic, std::size_t depth);
  void Read(Offered* offered);

  dds::Participant& participant_;
  dds::NodeLog& log_;
  FoxgloveHub* hub_;
  dds::Publications publications_;
  foxglove::ChannelId last_id_ = FoxgloveHub::kSceneChannel;
  std::map<TopicAndType, Offered> offered_;
};

}  // namespace palpate::view
