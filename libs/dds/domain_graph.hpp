// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "libs/dds/entity.hpp"
#include "libs/dds/raw_reader.hpp"
#include "libs/dds/ros_nodes.hpp"
#include "libs/dds/security_qos.hpp"
#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

/// One writer or reader somewhere in the domain.
struct DomainEndpoint {
  Guid guid{};
  Guid participant{};
  bool is_writer = false;
  std::string dds_topic;
  std::string dds_type;
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  int depth = 0;                    ///< 0: keeps all
  std::int64_t deadline_ns = 0;     ///< DDS_INFINITY: none
  std::int64_t lifespan_ns = 0;     ///< DDS_INFINITY: for ever
  std::int64_t lease_ns = 0;        ///< of liveliness; DDS_INFINITY: for ever
  bool liveliness_by_hand = false;  ///< it must say itself that it lives
  bool has_key = false;             ///< of its type; known of writers only
  /// Structure of its type as OMG IDL, where it was asked for and the writer says it.
  std::string omg_idl;
};

/// One process on DDS, whether or not it has nodes of ROS 2.
struct DomainParticipant {
  Guid guid{};
  std::string host;     ///< empty: it does not say
  std::string process;  ///< name of its program; empty: it does not say
  std::string pid;
};

/// "01.0f.ab", as ROS 2 writes it.
std::string GuidText(const Guid& guid);

/// What there is in a domain: participants, writers, readers and nodes of ROS 2, but for its own
/// participant, which is no node. Not thread-safe.
class DomainGraph {
 public:
  using Clock = std::chrono::steady_clock;
  using Guids = std::vector<Guid>;
  using NeedsIdl = std::function<bool(const DomainEndpoint&)>;

  /// Joins the domain. `needs_idl`(writer): whether the structure of its type is to be asked for,
  /// which takes up to a second where it does not answer. Throws as CreateParticipant does.
  explicit DomainGraph(std::uint32_t domain_id, NeedsIdl needs_idl = {},
                       const SecuritySettings& security = {});
  ~DomainGraph();

  std::uint32_t domain_id() const { return domain_id_; }
  dds_entity_t participant() const { return participant_.handle(); }
  const std::map<Guid, DomainParticipant>& participants() const { return participants_; }
  const std::map<Guid, DomainEndpoint>& endpoints() const { return endpoints_; }
  /// Sorted by name.
  std::vector<RosNode> Nodes() const;
  /// nullptr: no node has announced that endpoint.
  const RosNode* NodeOf(const Guid& endpoint) const;

  /// Takes what has changed until `done()` holds, which is asked after every change; false where
  /// that takes until `deadline`.
  bool WatchUntil(const std::function<bool()>& done, Clock::time_point deadline);
  /// Takes what has changed until all that is announced is there and nothing more comes: 0.3 s
  /// where there is little, at most until `deadline`.
  void WatchUntilComplete(Clock::time_point deadline);

 private:
  bool Update();
  bool TakeEndpoints(dds_entity_t reader, bool writers);
  bool TakeParticipants();
  bool TakeNodes();
  bool IsComplete() const;
  /// Until something may have changed.
  void Wait(Clock::time_point until) const;

  std::uint32_t domain_id_;
  NeedsIdl needs_idl_;
  std::shared_ptr<Entity> domain_;  ///< goes after the entities in it
  Entity participant_;
  Guid own_guid_{};
  std::map<Guid, DomainParticipant> participants_;
  std::map<Guid, DomainEndpoint> endpoints_;
  std::map<Guid, std::vector<RosNode>> nodes_;  ///< by participant
  std::mutex mutex_;                            ///< of announced_
  std::vector<RawMessage> announced_;
  Entity guard_;  ///< is set when something was announced
  Entity participant_reader_;
  Entity writer_reader_;
  Entity reader_reader_;
  Entity wait_set_;
  std::unique_ptr<RawReader> discovery_;  ///< goes first: its thread uses the above
};

}  // namespace palpate::dds
