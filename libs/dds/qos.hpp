// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>

#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};

/// Owned settings of an entity, ready for dds_create_...
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

/// What ROS 2 nodes expect of a participant, and what it says about its process (peers.hpp).
/// `enclave`: its name in ROS 2, "/" where not secured.
Qos ParticipantQos(const std::string& enclave = "/");

/// The partition in which only processes of this host are.
std::string PartitionOfThisHost();

/// The row of the topic table as QoS; XCDR1 always, never autodispose (as ROS 2 has it). With
/// this_host_only the writer is in PartitionOfThisHost() alone, the reader in the default one too.
Qos WriterQos(const TopicSettings& topic);
Qos ReaderQos(const TopicSettings& topic);

}  // namespace palpate::dds
