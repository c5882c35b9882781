// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/qos.hpp"

#include <array>
#include <cmath>
#include <string>

#include "libs/dds/host.hpp"
#include "libs/dds/peers.hpp"

namespace palpate::dds {

namespace {

constexpr dds_duration_t kMaxBlocking = DDS_MSECS(100);

dds_duration_t Nanoseconds(double seconds) {
  return static_cast<dds_duration_t>(std::llround(seconds * 1e9));
}

Qos EndpointQos(const TopicSettings& topic) {
  Qos qos(dds_create_qos());
  const bool reliable = topic.reliability == Reliability::kReliable;
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kMaxBlocking);
  const bool latched = topic.durability == Durability::kTransientLocal;
  dds_qset_durability(qos.get(),
                      latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, topic.depth);
  if (topic.deadline_s) dds_qset_deadline(qos.get(), Nanoseconds(*topic.deadline_s));
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &xcdr1);
  return qos;
}

}  // namespace

Qos ParticipantQos(const std::string& enclave) {
  const std::string user_data = "enclave=" + enclave + ";" + ToUserData(ThisProcess());
  Qos qos(dds_create_qos());
  dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  return qos;
}

std::string PartitionOfThisHost() { return "local:" + ThisHost().id; }

Qos WriterQos(const TopicSettings& topic) {
  Qos qos = EndpointQos(topic);
  if (topic.this_host_only) dds_qset_partition1(qos.get(), PartitionOfThisHost().c_str());
  dds_qset_writer_data_lifecycle(qos.get(), false);
  if (topic.durability == Durability::kTransientLocal) {
    // What late joiners get is governed by this one, not by the history.
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, topic.depth,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  return qos;
}

Qos ReaderQos(const TopicSettings& topic) {
  Qos qos = EndpointQos(topic);
  if (topic.this_host_only) {
    const std::string here = PartitionOfThisHost();
    std::array<const char*, 2> partitions{"", here.c_str()};
    dds_qset_partition(qos.get(), partitions.size(), partitions.data());
  }
  return qos;
}

}  // namespace palpate::dds
