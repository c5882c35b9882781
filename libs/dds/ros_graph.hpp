// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

#include "libs/dds/entity.hpp"

namespace palpate::dds {

/// How ROS 2 writes the identifier of an endpoint on the topic ros_discovery_info.
enum class GidLayout {
  kHumble,  ///< 24 octets, up to Humble
  kIron,    ///< 16 octets, from Iron on
};

/// Name and endpoints of one node, announced on `ros_discovery_info`, so that `ros2 node list` and
/// `ros2 node info` show it.
class RosGraph {
 public:
  /// Throws RunError where DDS refuses.
  RosGraph(dds_entity_t participant, std::string node_namespace, std::string node_name,
           GidLayout layout);

  /// Adds an endpoint and announces the node again. Throws RunError where it cannot be sent.
  void AddWriter(dds_entity_t writer);
  void AddReader(dds_entity_t reader);
  void Add(const std::vector<dds_entity_t>& writers, const std::vector<dds_entity_t>& readers);

 private:
  void Announce();
  template <typename Info>
  void AnnounceAs();

  std::string node_namespace_;
  std::string node_name_;
  GidLayout layout_;
  dds_guid_t participant_guid_{};
  std::vector<dds_guid_t> writers_;
  std::vector<dds_guid_t> readers_;
  Entity topic_;
  Entity writer_;
};

}  // namespace palpate::dds
