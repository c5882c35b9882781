// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/publications.hpp"

#include <algorithm>
#include <utility>

#include "libs/dds/peers.hpp"
#include "libs/dds/qos.hpp"
#include "libs/dds/type_idl.hpp"

namespace palpate::dds {

namespace {

bool IsInPartition(const dds_qos_t* qos, const std::string& name) {
  std::uint32_t count = 0;
  char** partitions = nullptr;
  if (!dds_qget_partition(qos, &count, &partitions)) return false;
  bool found = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    found = found || name == partitions[i];
    dds_free(partitions[i]);
  }
  dds_free(partitions);
  return found;
}

Publication PublicationOf(const dds_builtintopic_endpoint_t& endpoint) {
  Publication publication;
  publication.guid = ToArray(endpoint.key);
  // The last octet says what kind of endpoint it is (RTPS 2.3, table 9.1): 2 is a writer with key.
  constexpr unsigned kKindBits = 0x0F;
  constexpr unsigned kWriterWithKey = 2;
  publication.has_key = (publication.guid.back() & kKindBits) == kWriterWithKey;
  publication.dds_topic = endpoint.topic_name;
  publication.dds_type = endpoint.type_name;
  publication.participant = ToArray(endpoint.participant_key);
  publication.this_host_only = IsInPartition(endpoint.qos, PartitionOfThisHost());
  dds_reliability_kind_t reliability{};
  if (dds_qget_reliability(endpoint.qos, &reliability, nullptr) &&
      reliability == DDS_RELIABILITY_BEST_EFFORT) {
    publication.reliability = Reliability::kBestEffort;
  }
  dds_durability_kind_t durability{};
  if (dds_qget_durability(endpoint.qos, &durability) && durability != DDS_DURABILITY_VOLATILE) {
    publication.durability = Durability::kTransientLocal;
  }
  dds_history_kind_t history{};
  std::int32_t depth = 0;
  if (dds_qget_history(endpoint.qos, &history, &depth) && history == DDS_HISTORY_KEEP_LAST) {
    publication.depth = static_cast<std::uint32_t>(std::max(0, depth));
  }
  return publication;
}

}  // namespace

RawTopic RawTopicOf(const Publication& publication) {
  return {.dds_topic = publication.dds_topic,
          .dds_type = publication.dds_type,
          .reliability = publication.reliability,
          .durability = publication.durability,
          .has_key = publication.has_key,
          .this_host_only = publication.this_host_only};
}

bool AskLess(const Publication& publication, RawTopic* asked) {
  const bool too_reliable = asked->reliability == Reliability::kReliable &&
                            publication.reliability == Reliability::kBestEffort;
  const bool too_durable = asked->durability == Durability::kTransientLocal &&
                           publication.durability == Durability::kVolatile;
  if (too_reliable) asked->reliability = Reliability::kBestEffort;
  if (too_durable) asked->durability = Durability::kVolatile;
  return too_reliable || too_durable;
}

Publications::Publications(dds_entity_t participant,
                           std::function<bool(const std::string&)> needs_idl)
    : participant_(participant),
      needs_idl_(std::move(needs_idl)),
      reader_(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
              "reader of the writers of the domain") {
  dds_guid_t guid;
  if (dds_get_guid(participant, &guid) == DDS_RETCODE_OK) own_guid_ = ToArray(guid);
}

bool Publications::Update() {
  bool changed = false;
  std::array<void*, 16> samples{};
  std::array<dds_sample_info_t, 16> infos{};
  dds_return_t count = 0;
  while ((count = dds_take(reader_.handle(), samples.data(), infos.data(), samples.size(),
                           samples.size())) > 0) {
    for (int i = 0; i < count; ++i) {
      auto& endpoint = *static_cast<dds_builtintopic_endpoint_t*>(samples[static_cast<size_t>(i)]);
      const dds_sample_info_t& info = infos[static_cast<size_t>(i)];
      if (ToArray(endpoint.participant_key) == own_guid_ && info.valid_data) continue;
      if (info.instance_state == DDS_IST_ALIVE && info.valid_data) {
        Publication publication = PublicationOf(endpoint);
        if (needs_idl_(publication.dds_type)) {
          publication.omg_idl = IdlOfEndpoint(participant_, endpoint);
        }
        all_.insert_or_assign(publication.guid, std::move(publication));
        changed = true;
      } else {
        changed = all_.erase(ToArray(endpoint.key)) > 0 || changed;
      }
    }
    dds_return_loan(reader_.handle(), samples.data(), count);
    samples.fill(nullptr);
  }
  return changed;
}

}  // namespace palpate::dds
