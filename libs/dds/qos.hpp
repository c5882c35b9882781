// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <memory>

#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};

/// Owned settings of an entity, ready for dds_create_...
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

/// What ROS 2 nodes expect of a participant.
Qos ParticipantQos();

/// The row of the topic table as QoS; XCDR1 always, never autodispose (as ROS 2 has it).
Qos WriterQos(const TopicSettings& topic);
Qos ReaderQos(const TopicSettings& topic);

}  // namespace palpate::dds
