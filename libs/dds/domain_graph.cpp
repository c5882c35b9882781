// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/domain_graph.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <utility>

#include "libs/dds/domain.hpp"
#include "libs/dds/type_idl.hpp"

namespace palpate::dds {

namespace {

using std::chrono::milliseconds;

/// Found on the network alone, without an answer to a question: so long it takes at least.
constexpr auto kLeastWatch = milliseconds(300);
/// So long nothing must have come.
constexpr auto kQuiet = milliseconds(150);

Guid ToGuid(const dds_guid_t& guid) {
  Guid array{};
  std::memcpy(array.data(), guid.v, array.size());
  return array;
}

std::string Property(const dds_qos_t* qos, const char* name) {
  char* value = nullptr;
  if (!dds_qget_prop(qos, name, &value) || value == nullptr) return {};
  std::string text = value;
  dds_free(value);
  return text;
}

void ReadTimes(const dds_qos_t* qos, DomainEndpoint* endpoint) {
  dds_duration_t time = DDS_INFINITY;
  endpoint->deadline_ns = dds_qget_deadline(qos, &time) ? time : DDS_INFINITY;
  endpoint->lifespan_ns = dds_qget_lifespan(qos, &time) ? time : DDS_INFINITY;
  dds_liveliness_kind_t liveliness = DDS_LIVELINESS_AUTOMATIC;
  endpoint->lease_ns = dds_qget_liveliness(qos, &liveliness, &time) ? time : DDS_INFINITY;
  endpoint->liveliness_by_hand = liveliness != DDS_LIVELINESS_AUTOMATIC;
}

DomainEndpoint EndpointOf(const dds_builtintopic_endpoint_t& sample, bool is_writer) {
  DomainEndpoint endpoint;
  endpoint.guid = ToGuid(sample.key);
  endpoint.participant = ToGuid(sample.participant_key);
  endpoint.is_writer = is_writer;
  endpoint.dds_topic = sample.topic_name;
  endpoint.dds_type = sample.type_name;
  // The last octet says what kind of endpoint it is (RTPS 2.3, table 9.1): 2 is a writer with key.
  endpoint.has_key = is_writer && (endpoint.guid.back() & 0x0F) == 2;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_RELIABLE;
  dds_qget_reliability(sample.qos, &reliability, nullptr);
  endpoint.reliability =
      reliability == DDS_RELIABILITY_RELIABLE ? Reliability::kReliable : Reliability::kBestEffort;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_qget_durability(sample.qos, &durability);
  endpoint.durability =
      durability == DDS_DURABILITY_VOLATILE ? Durability::kVolatile : Durability::kTransientLocal;
  dds_history_kind_t history = DDS_HISTORY_KEEP_ALL;
  std::int32_t depth = 0;
  dds_qget_history(sample.qos, &history, &depth);
  endpoint.depth = history == DDS_HISTORY_KEEP_LAST ? depth : 0;
  ReadTimes(sample.qos, &endpoint);
  return endpoint;
}

/// Calls `take`(sample, whether it is there now) for what waits in a reader of a built-in topic;
/// true where anything did.
template <typename Sample, typename Take>
bool TakeAll(dds_entity_t reader, const Take& take) {
  bool any = false;
  std::array<void*, 16> samples{};
  std::array<dds_sample_info_t, 16> infos{};
  dds_return_t count = 0;
  while ((count = dds_take(reader, samples.data(), infos.data(), samples.size(), samples.size())) >
         0) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      take(*static_cast<Sample*>(samples[i]),
           infos[i].valid_data && infos[i].instance_state == DDS_IST_ALIVE);
      any = true;
    }
    dds_return_loan(reader, samples.data(), count);
    samples.fill(nullptr);
  }
  return any;
}

Entity BuiltInReader(dds_entity_t participant, dds_entity_t topic) {
  return Entity(dds_create_reader(participant, topic, nullptr, nullptr),
                "reader of what is in the domain");
}

}  // namespace

std::string GuidText(const Guid& guid) {
  std::string text;
  for (const std::uint8_t octet : guid) {
    std::array<char, 4> hex{};
    std::snprintf(hex.data(), hex.size(), "%02x", octet);
    text += (text.empty() ? "" : ".") + std::string(hex.data());
  }
  return text;
}

DomainGraph::DomainGraph(std::uint32_t domain_id, NeedsIdl needs_idl,
                         const SecuritySettings& security)
    : domain_id_(domain_id),
      needs_idl_(std::move(needs_idl)),
      domain_(ApplyDomainSettings(domain_id, security.enabled())),
      participant_(CreateParticipant(domain_id, security)),
      guard_(dds_create_guardcondition(participant_.handle()), "a guard condition"),
      participant_reader_(BuiltInReader(participant_.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)),
      writer_reader_(BuiltInReader(participant_.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
      reader_reader_(BuiltInReader(participant_.handle(), DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)),
      wait_set_(dds_create_waitset(participant_.handle()), "a waitset") {
  dds_guid_t guid{};
  if (dds_get_guid(participant_.handle(), &guid) == DDS_RETCODE_OK) own_guid_ = ToGuid(guid);
  for (const Entity* reader : {&participant_reader_, &writer_reader_, &reader_reader_}) {
    dds_set_status_mask(reader->handle(), DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(wait_set_.handle(), reader->handle(), 0);
  }
  dds_waitset_attach(wait_set_.handle(), guard_.handle(), 0);
  RawTopic topic{.dds_topic = "ros_discovery_info",
                 .dds_type = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                 .reliability = Reliability::kReliable,
                 .durability = Durability::kTransientLocal};
  discovery_ =
      std::make_unique<RawReader>(participant_.handle(), topic, [this](RawMessage message) {
        const std::lock_guard lock(mutex_);
        announced_.push_back(std::move(message));
        dds_set_guardcondition(guard_.handle(), true);
      });
}

DomainGraph::~DomainGraph() { discovery_.reset(); }

std::vector<RosNode> DomainGraph::Nodes() const {
  std::vector<RosNode> nodes;
  for (const auto& [participant, announced] : nodes_) {
    nodes.insert(nodes.end(), announced.begin(), announced.end());
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const RosNode& a, const RosNode& b) { return a.FullName() < b.FullName(); });
  return nodes;
}

const RosNode* DomainGraph::NodeOf(const Guid& endpoint) const {
  const auto has = [&](const Guids& guids) {
    return std::find(guids.begin(), guids.end(), endpoint) != guids.end();
  };
  for (const auto& [participant, announced] : nodes_) {
    for (const RosNode& node : announced) {
      if (has(node.writers) || has(node.readers)) return &node;
    }
  }
  return nullptr;
}

bool DomainGraph::TakeParticipants() {
  return TakeAll<dds_builtintopic_participant_t>(
      participant_reader_.handle(), [&](const dds_builtintopic_participant_t& sample, bool alive) {
        const Guid guid = ToGuid(sample.key);
        if (guid == own_guid_) return;
        if (!alive) {
          participants_.erase(guid);
          nodes_.erase(guid);
          return;
        }
        participants_[guid] = {guid, Property(sample.qos, "__Hostname"),
                               Property(sample.qos, "__ProcessName"),
                               Property(sample.qos, "__Pid")};
      });
}

bool DomainGraph::TakeEndpoints(dds_entity_t reader, bool writers) {
  return TakeAll<dds_builtintopic_endpoint_t>(
      reader, [&](dds_builtintopic_endpoint_t& sample, bool alive) {
        if (!alive) {
          endpoints_.erase(ToGuid(sample.key));
          return;
        }
        DomainEndpoint endpoint = EndpointOf(sample, writers);
        if (endpoint.participant == own_guid_) return;
        if (writers && needs_idl_ && needs_idl_(endpoint)) {
          endpoint.omg_idl = IdlOfEndpoint(participant_.handle(), sample);
        }
        endpoints_.insert_or_assign(endpoint.guid, std::move(endpoint));
      });
}

bool DomainGraph::TakeNodes() {
  bool was_set = false;
  dds_take_guardcondition(guard_.handle(), &was_set);
  std::vector<RawMessage> announced;
  {
    const std::lock_guard lock(mutex_);
    announced.swap(announced_);
  }
  for (const RawMessage& message : announced) {
    auto info = ParseDiscoveryInfo(message.cdr());
    if (info) nodes_[info->participant] = std::move(info->nodes);
  }
  return !announced.empty();
}

bool DomainGraph::Update() {
  const bool nodes = TakeNodes();
  const bool participants = TakeParticipants();
  const bool writers = TakeEndpoints(writer_reader_.handle(), true);
  const bool readers = TakeEndpoints(reader_reader_.handle(), false);
  return nodes || participants || writers || readers;
}

bool DomainGraph::WatchUntil(const std::function<bool()>& done, Clock::time_point deadline) {
  for (;;) {
    Update();
    if (done()) return true;
    if (Clock::now() >= deadline) return false;
    Wait(deadline);
  }
}

void DomainGraph::Wait(Clock::time_point until) const {
  const auto left = std::chrono::ceil<std::chrono::nanoseconds>(until - Clock::now());
  (void)dds_waitset_wait(wait_set_.handle(), nullptr, 0, std::max<dds_duration_t>(0, left.count()));
}

bool DomainGraph::IsComplete() const {
  const auto all_known = [&](const Guids& guids) {
    return std::all_of(guids.begin(), guids.end(),
                       [&](const Guid& guid) { return endpoints_.contains(guid); });
  };
  for (const auto& [participant, announced] : nodes_) {
    for (const RosNode& node : announced) {
      if (!all_known(node.writers) || !all_known(node.readers)) return false;
    }
  }
  return true;
}

void DomainGraph::WatchUntilComplete(Clock::time_point deadline) {
  const Clock::time_point begin = Clock::now();
  Clock::time_point last_change = begin;
  for (;;) {
    const bool changed = Update();
    const Clock::time_point now = Clock::now();
    if (changed) last_change = now;
    const Clock::time_point quiet = std::max(begin + kLeastWatch, last_change + kQuiet);
    if (now >= deadline || (now >= quiet && IsComplete())) return;
    Wait(std::min(deadline, now < quiet ? quiet : now + kQuiet));
  }
}

}  // namespace palpate::dds
