// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/raw_writer.hpp"

#include <atomic>
#include <utility>

#include "libs/dds/qos.hpp"
#include "libs/dds/raw_type.hpp"

namespace palpate::dds {

namespace {

struct DeleteWriterListener {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

Qos RawWriterQos(const RawWriterTopic& topic) {
  TopicSettings settings;
  settings.reliability = topic.reliability;
  settings.durability = topic.durability;
  settings.depth = topic.depth;
  settings.this_host_only = topic.this_host_only;
  Qos qos = WriterQos(settings);
  const dds_data_representation_id_t representation =
      topic.is_xcdr2 ? DDS_DATA_REPRESENTATION_XCDR2 : DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &representation);
  if (topic.has_key && topic.durability == Durability::kTransientLocal) {
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  return qos;
}

}  // namespace

struct RawWriter::State {
  const ddsi_sertype* type = nullptr;
  std::atomic<std::uint32_t> matched{0};
  std::atomic<std::uint32_t> matched_ever{0};
  std::function<void()> on_change;
};

void RawWriter::DeleteState::operator()(State* state) const { delete state; }

struct RawWriter::Callbacks {
  static void OnMatched(dds_entity_t, const dds_publication_matched_status_t status,
                        void* argument) {
    State& state = *static_cast<State*>(argument);
    state.matched_ever = status.total_count;
    state.matched = status.current_count;
    if (state.on_change) state.on_change();
  }
};

RawWriter::RawWriter(dds_entity_t participant, const RawWriterTopic& topic,
                     std::function<void()> on_change)
    : state_(new State),
      topic_(CreateRawTopic(participant, topic.dds_topic, topic.dds_type, topic.has_key,
                            &state_->type)) {
  state_->on_change = std::move(on_change);
  const std::unique_ptr<dds_listener_t, DeleteWriterListener> listener(
      dds_create_listener(state_.get()));
  dds_lset_publication_matched(listener.get(), Callbacks::OnMatched);
  writer_ = Entity(
      dds_create_writer(participant, topic_.handle(), RawWriterQos(topic).get(), listener.get()),
      "writer of " + topic.dds_topic);
}

bool RawWriter::Write(std::string_view cdr) { return WriteCdr(handle(), state_->type, cdr); }

bool RawWriter::WaitUntilReceived(std::chrono::nanoseconds at_most) {
  return dds_wait_for_acks(handle(), at_most.count()) == DDS_RETCODE_OK;
}

std::uint32_t RawWriter::matched() const { return state_->matched; }
std::uint32_t RawWriter::matched_ever() const { return state_->matched_ever; }

bool IsXcdr2(std::string_view cdr) {
  // Second octet of the header (DDS-XTypes 1.3, table 60): 6 to 11 are encodings of XCDR2.
  return cdr.size() >= 2 && static_cast<unsigned char>(cdr[1]) >= 6;
}

}  // namespace palpate::dds
