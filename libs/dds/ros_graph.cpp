// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_graph.hpp"

#include <cstring>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/qos.hpp"
#include "rmw_dds_common/msg/ParticipantEntitiesInfo.hpp"
#include "rmw_dds_common_iron/msg/ParticipantEntitiesInfo.hpp"

namespace palpate::dds {

namespace {

using HumbleInfo = idl::rmw_dds_common::ParticipantEntitiesInfo;
using IronInfo = idl::rmw_dds_common_iron::ParticipantEntitiesInfo;

constexpr char kTopicName[] = "ros_discovery_info";

dds_guid_t GuidOf(dds_entity_t entity) {
  dds_guid_t guid;
  const dds_return_t result = dds_get_guid(entity, &guid);
  if (result != DDS_RETCODE_OK) {
    throw RunError(std::string("cannot read the GUID of an endpoint: ") + dds_strretcode(-result));
  }
  return guid;
}

template <typename Gid>
void SetGid(Gid& gid, const dds_guid_t& guid) {
  static_assert(sizeof(gid.data) >= sizeof(guid.v));
  std::memset(gid.data, 0, sizeof(gid.data));
  std::memcpy(gid.data, guid.v, sizeof(guid.v));
}

template <typename GidSequence>
void SetGids(GidSequence& sequence, const std::vector<dds_guid_t>& guids) {
  Resize(sequence, guids.size());
  for (size_t i = 0; i < guids.size(); ++i) SetGid(sequence._buffer[i], guids[i]);
}

/// Both layouts go by one type name on the wire; in this program they need two.
dds_topic_descriptor_t Descriptor(GidLayout layout) {
  const dds_topic_descriptor_t& humble = idl::MessageTraits<HumbleInfo>::Descriptor();
  if (layout == GidLayout::kHumble) return humble;
  dds_topic_descriptor_t iron = idl::MessageTraits<IronInfo>::Descriptor();
  iron.m_typename = humble.m_typename;
  return iron;
}

Entity CreateTopic(dds_entity_t participant, GidLayout layout) {
  const dds_topic_descriptor_t descriptor = Descriptor(layout);
  return Entity(dds_create_topic(participant, &descriptor, kTopicName, nullptr, nullptr),
                kTopicName);
}

Entity CreateWriter(dds_entity_t participant, dds_entity_t topic) {
  TopicSettings latched;
  latched.durability = Durability::kTransientLocal;
  return Entity(dds_create_writer(participant, topic, WriterQos(latched).get(), nullptr),
                std::string("writer of ") + kTopicName);
}

}  // namespace

RosGraph::RosGraph(dds_entity_t participant, std::string node_namespace, std::string node_name,
                   GidLayout layout)
    : node_namespace_(std::move(node_namespace)),
      node_name_(std::move(node_name)),
      layout_(layout),
      participant_guid_(GuidOf(participant)),
      topic_(CreateTopic(participant, layout)),
      writer_(CreateWriter(participant, topic_.handle())) {
  Announce();
}

void RosGraph::AddWriter(dds_entity_t writer) {
  writers_.push_back(GuidOf(writer));
  Announce();
}

void RosGraph::AddReader(dds_entity_t reader) {
  readers_.push_back(GuidOf(reader));
  Announce();
}

void RosGraph::Add(const std::vector<dds_entity_t>& writers,
                   const std::vector<dds_entity_t>& readers) {
  for (const dds_entity_t writer : writers) writers_.push_back(GuidOf(writer));
  for (const dds_entity_t reader : readers) readers_.push_back(GuidOf(reader));
  Announce();
}

void RosGraph::Announce() {
  layout_ == GidLayout::kHumble ? AnnounceAs<HumbleInfo>() : AnnounceAs<IronInfo>();
}

template <typename Info>
void RosGraph::AnnounceAs() {
  Message<Info> info;
  SetGid(info->gid, participant_guid_);
  Resize(info->node_entities_info_seq, 1);
  auto& node = info->node_entities_info_seq._buffer[0];
  SetText(node.node_namespace, node_namespace_);
  SetText(node.node_name, node_name_);
  SetGids(node.reader_gid_seq, readers_);
  SetGids(node.writer_gid_seq, writers_);
  const dds_return_t result = dds_write(writer_.handle(), &*info);
  if (result != DDS_RETCODE_OK) {
    throw RunError(std::string("cannot announce the node: ") + dds_strretcode(-result));
  }
}

}  // namespace palpate::dds
