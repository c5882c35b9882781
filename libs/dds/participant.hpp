// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "libs/dds/domain.hpp"
#include "libs/dds/entity.hpp"
#include "libs/dds/reader.hpp"
#include "libs/dds/ros_graph.hpp"
#include "libs/dds/topic_table.hpp"
#include "libs/dds/topics.hpp"
#include "libs/dds/writer.hpp"

namespace palpate::dds {

struct ParticipantSettings {
  uint32_t domain_id = 0;  ///< 0 to 232, ROS_DOMAIN_ID
  std::string node_name;   ///< as `ros2 node list` shows it
  std::string node_namespace = "/";
  GidLayout gid_layout = GidLayout::kHumble;
};

/// One process on DDS, seen by ROS 2 as one node. Makes all writers and readers, by the topic
/// table. Must outlive them. Not thread-safe.
class Participant {
 public:
  /// Where CYCLONEDDS_URI is not set, config/cyclonedds/default.xml holds. Throws RunError where
  /// DDS refuses (no network interface, too many processes, bad CYCLONEDDS_URI).
  Participant(const ParticipantSettings& settings, TopicTable table);

  dds_entity_t handle() const { return entity_.handle(); }
  const TopicTable& table() const { return table_; }
  const std::string& node_name() const { return node_name_; }
  uint32_t domain_id() const { return domain_id_; }

  /// `name` takes the place of "<name>" in the topic's name. `on_change`: see EndpointCounters.
  /// Throws InputError where the table has no such topic or another type, RunError where DDS
  /// refuses.
  template <typename T>
  Writer<T> CreateWriter(const Topic<T>& topic, std::function<void()> on_change = {},
                         const std::string& name = {}) {
    Writer<T> writer(handle(), table_.At(topic.name), RosName(topic.name, name),
                     std::move(on_change));
    graph_.AddWriter(writer.handle());
    return writer;
  }
  template <typename T>
  Reader<T> CreateReader(const Topic<T>& topic, std::function<void()> on_change = {},
                         const std::string& name = {}) {
    Reader<T> reader(handle(), table_.At(topic.name), RosName(topic.name, name),
                     std::move(on_change));
    graph_.AddReader(reader.handle());
    return reader;
  }

 private:
  static std::string RosName(std::string_view topic_name, const std::string& name);

  std::string node_name_;
  uint32_t domain_id_;
  TopicTable table_;
  std::shared_ptr<Entity> domain_;  ///< goes after the entities in it
  Entity entity_;
  RosGraph graph_;
};

}  // namespace palpate::dds
