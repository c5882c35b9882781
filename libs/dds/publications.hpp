// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "libs/dds/entity.hpp"
#include "libs/dds/raw_reader.hpp"
#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

/// One writer somewhere in the domain.
struct Publication {
  std::array<std::uint8_t, 16> guid{};
  std::string dds_topic;
  std::string dds_type;
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  std::uint32_t depth = 0;                     ///< 0: keeps all
  bool has_key = false;                        ///< of its type
  bool this_host_only = false;                 ///< in PartitionOfThisHost()
  std::array<std::uint8_t, 16> participant{};  ///< its GUID
  /// Structure of its type as OMG IDL; empty where it sends none, as ROS 2's writers do.
  std::string omg_idl;

  bool operator==(const Publication&) const = default;
};

/// What reads all that this writer sends.
RawTopic RawTopicOf(const Publication& publication);

/// Lowers what is asked for to what a further writer of the topic offers: a reader that asks for
/// more gets nothing of that writer. True where that changed anything.
bool AskLess(const Publication& publication, RawTopic* asked);

/// All writers of a domain but those of its own participant.
class Publications {
 public:
  /// `needs_idl`(DDS type): whether the structure of the type is to be asked for, which takes up to
  /// a second where its writer does not answer. Throws RunError where DDS refuses.
  Publications(dds_entity_t participant, std::function<bool(const std::string&)> needs_idl);

  /// To be attached to a wait set.
  dds_entity_t reader() const { return reader_.handle(); }

  /// Takes what has changed; true where anything has.
  bool Update();

  const std::map<std::array<std::uint8_t, 16>, Publication>& all() const { return all_; }

 private:
  dds_entity_t participant_;
  std::array<std::uint8_t, 16> own_guid_{};
  std::function<bool(const std::string&)> needs_idl_;
  Entity reader_;
  std::map<std::array<std::uint8_t, 16>, Publication> all_;
};

}  // namespace palpate::dds
