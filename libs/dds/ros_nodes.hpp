// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::dds {

using Guid = std::array<std::uint8_t, 16>;

/// One node of ROS 2, as its participant announces it on ros_discovery_info.
struct RosNode {
  std::string node_namespace;  ///< "/", "/left"
  std::string name;
  Guid participant{};
  std::vector<Guid> readers;
  std::vector<Guid> writers;

  /// "/left/palpate_view"
  std::string FullName() const {
    return (node_namespace == "/" ? "" : node_namespace) + "/" + name;
  }
};

/// What one participant says of its nodes.
struct AnnouncedNodes {
  Guid participant{};
  std::vector<RosNode> nodes;
};

/// Reads a message of ros_discovery_info, whose identifiers have 24 octets up to Humble, and 16
/// from Iron on: the layout that fits. `cdr`: with its header of 4 bytes. nullopt: neither fits.
std::optional<AnnouncedNodes> ParseDiscoveryInfo(std::string_view cdr);

}  // namespace palpate::dds
