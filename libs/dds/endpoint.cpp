// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/endpoint.hpp"

#include <utility>

#include "libs/core/error.hpp"
#include "libs/dds/qos.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

struct ListenerDeleter {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};
using Listener = std::unique_ptr<dds_listener_t, ListenerDeleter>;

EndpointCounters& CountersOf(void* argument) { return *static_cast<EndpointCounters*>(argument); }

void Changed(const EndpointCounters& counters) {
  if (counters.on_change) counters.on_change();
}

template <typename Status>
void OnMatched(dds_entity_t, const Status status, void* argument) {
  CountersOf(argument).matched_ever = status.total_count;
  CountersOf(argument).matched = status.current_count;
  Changed(CountersOf(argument));
}

template <typename Status>
void OnDeadlineMissed(dds_entity_t, const Status status, void* argument) {
  CountersOf(argument).deadline_missed = status.total_count;
  Changed(CountersOf(argument));
}

template <typename Status>
void OnIncompatibleQos(dds_entity_t, const Status status, void* argument) {
  CountersOf(argument).last_incompatible_policy = status.last_policy_id;
  CountersOf(argument).incompatible_qos = status.total_count;
  Changed(CountersOf(argument));
}

void OnSampleLost(dds_entity_t, const dds_sample_lost_status_t status, void* argument) {
  CountersOf(argument).sample_lost = status.total_count;
  Changed(CountersOf(argument));
}

Listener WriterListener(EndpointCounters* counters) {
  Listener listener(dds_create_listener(counters));
  dds_lset_publication_matched(listener.get(), OnMatched<dds_publication_matched_status_t>);
  dds_lset_offered_deadline_missed(listener.get(),
                                   OnDeadlineMissed<dds_offered_deadline_missed_status_t>);
  dds_lset_offered_incompatible_qos(listener.get(),
                                    OnIncompatibleQos<dds_offered_incompatible_qos_status_t>);
  return listener;
}

Listener ReaderListener(EndpointCounters* counters) {
  Listener listener(dds_create_listener(counters));
  dds_lset_subscription_matched(listener.get(), OnMatched<dds_subscription_matched_status_t>);
  dds_lset_requested_deadline_missed(listener.get(),
                                     OnDeadlineMissed<dds_requested_deadline_missed_status_t>);
  dds_lset_requested_incompatible_qos(listener.get(),
                                      OnIncompatibleQos<dds_requested_incompatible_qos_status_t>);
  dds_lset_sample_lost(listener.get(), OnSampleLost);
  return listener;
}

Entity CreateEndpoint(Endpoint::Kind kind, dds_entity_t participant, dds_entity_t topic,
                      const TopicSettings& settings, EndpointCounters* counters) {
  if (kind == Endpoint::Kind::kWriter) {
    return Entity(dds_create_writer(participant, topic, WriterQos(settings).get(),
                                    WriterListener(counters).get()),
                  "writer of " + settings.name);
  }
  return Entity(dds_create_reader(participant, topic, ReaderQos(settings).get(),
                                  ReaderListener(counters).get()),
                "reader of " + settings.name);
}

void CheckType(const TopicSettings& topic, const dds_topic_descriptor_t& descriptor) {
  if (DdsTypeName(topic.type) == descriptor.m_typename) return;
  throw InputError("topic '" + topic.name + "' has type " + topic.type +
                   " in the topic table, but this program sends " + descriptor.m_typename);
}

}  // namespace

std::string PolicyName(uint32_t id) {
  switch (id) {
    case DDS_RELIABILITY_QOS_POLICY_ID: return "reliability";
    case DDS_DURABILITY_QOS_POLICY_ID: return "durability";
    case DDS_DEADLINE_QOS_POLICY_ID: return "deadline";
    case DDS_LIVELINESS_QOS_POLICY_ID: return "liveliness";
    case DDS_OWNERSHIP_QOS_POLICY_ID: return "ownership";
    case DDS_DATA_REPRESENTATION_QOS_POLICY_ID: return "data representation";
    default: return "a policy";
  }
}

Endpoint::Endpoint(Kind kind, dds_entity_t participant, const TopicSettings& topic,
                   const std::string& ros_name, const dds_topic_descriptor_t& descriptor,
                   std::function<void()> on_change)
    : ros_name_(ros_name), counters_(std::make_unique<EndpointCounters>()) {
  CheckType(topic, descriptor);
  counters_->on_change = std::move(on_change);
  topic_ = Entity(
      dds_create_topic(participant, &descriptor, DdsTopicName(ros_name).c_str(), nullptr, nullptr),
      "topic " + ros_name);
  entity_ = CreateEndpoint(kind, participant, topic_.handle(), topic, counters_.get());
}

}  // namespace palpate::dds
