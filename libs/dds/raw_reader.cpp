// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/raw_reader.hpp"

#include <dds/dds.h>

#include <array>
#include <utility>

#include "libs/dds/qos.hpp"
#include "libs/dds/raw_type.hpp"

namespace palpate::dds {

namespace {

/// They are taken as they come; so many may wait while a large one is taken.
constexpr int kDepth = 1000;

struct DeleteListener {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

Qos RawReaderQos(const RawTopic& topic) {
  TopicSettings settings;
  settings.reliability = topic.reliability;
  settings.durability = topic.durability;
  settings.depth = kDepth;
  settings.this_host_only = topic.this_host_only;
  Qos qos = ReaderQos(settings);
  constexpr std::array<dds_data_representation_id_t, 2> kAny{DDS_DATA_REPRESENTATION_XCDR1,
                                                             DDS_DATA_REPRESENTATION_XCDR2};
  dds_qset_data_representation(qos.get(), kAny.size(), kAny.data());
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

}  // namespace

struct RawReader::Callbacks {
  static State& StateOf(void* argument) { return *static_cast<State*>(argument); }

  static void OnData(dds_entity_t reader, void* argument) {
    std::array<ddsi_serdata*, 16> taken{};
    std::array<dds_sample_info_t, 16> infos{};
    dds_return_t count = 0;
    do {
      count = dds_takecdr(reader, taken.data(), taken.size(), infos.data(), DDS_ANY_STATE);
      for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        RawMessage message(taken[index], infos[index].source_timestamp,
                           infos[index].publication_handle);
        if (infos[index].valid_data) StateOf(argument).on_message(std::move(message));
      }
    } while (count > 0);
  }

  static void OnLost(dds_entity_t, const dds_sample_lost_status_t status, void* argument) {
    StateOf(argument).lost = status.total_count;
  }

  static void OnMatched(dds_entity_t, const dds_subscription_matched_status_t status,
                        void* argument) {
    StateOf(argument).matched = status.current_count;
  }

  static void OnIncompatible(dds_entity_t, const dds_requested_incompatible_qos_status_t status,
                             void* argument) {
    StateOf(argument).policy = status.last_policy_id;
    StateOf(argument).incompatible = status.total_count;
  }
};

RawReader::RawReader(dds_entity_t participant, const RawTopic& topic, OnMessage on_message)
    : state_(std::make_unique<State>()),
      topic_(CreateRawTopic(participant, topic.dds_topic, topic.dds_type, topic.has_key)) {
  state_->on_message = std::move(on_message);
  const std::unique_ptr<dds_listener_t, DeleteListener> listener(dds_create_listener(state_.get()));
  dds_lset_data_available(listener.get(), Callbacks::OnData);
  dds_lset_sample_lost(listener.get(), Callbacks::OnLost);
  dds_lset_subscription_matched(listener.get(), Callbacks::OnMatched);
  dds_lset_requested_incompatible_qos(listener.get(), Callbacks::OnIncompatible);
  reader_ = Entity(
      dds_create_reader(participant, topic_.handle(), RawReaderQos(topic).get(), listener.get()),
      "reader of " + topic.dds_topic);
}

}  // namespace palpate::dds
