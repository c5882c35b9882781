// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_nodes.hpp"

#include <gtest/gtest.h>

#include "libs/dds/domain_graph.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

/// What a participant with GUID 1 1 1 ... announces of one node with one reader, with identifiers
/// of `gid_size` octets.
std::string Announcement(std::size_t gid_size) {
  const auto gid = [&](char octet) {
    return std::string(16, octet) + std::string(gid_size - 16, '\0');
  };
  const auto length = [](char size) { return std::string{size, 0, 0, 0}; };
  std::string cdr = std::string("\0\1\0\0", 4) + gid(1) + length(1);
  cdr += length(6) + std::string("/left\0\0\0", 8);
  cdr += length(5) + std::string("node\0\0\0\0", 8);
  return cdr + length(1) + gid(2) + length(0);
}

TEST(RosNodes, AreReadInTheLayoutsOfHumbleAndIron) {
  for (const std::size_t gid_size : {24u, 16u}) {
    const auto info = ParseDiscoveryInfo(Announcement(gid_size));
    ASSERT_TRUE(info) << gid_size;
    EXPECT_EQ(info->participant[15], 1);
    ASSERT_EQ(info->nodes.size(), 1u);
    EXPECT_EQ(info->nodes[0].FullName(), "/left/node");
    ASSERT_EQ(info->nodes[0].readers.size(), 1u);
    EXPECT_EQ(info->nodes[0].readers[0][0], 2);
    EXPECT_TRUE(info->nodes[0].writers.empty());
  }
}

TEST(RosNodes, AreNotReadFromWhatIsCut) {
  const std::string whole = Announcement(24);
  for (std::size_t size = 0; size + 4 < whole.size(); ++size) {
    // Cut after its gid, a message of Humble is one of Iron without nodes.
    const auto info = ParseDiscoveryInfo(whole.substr(0, size));
    EXPECT_TRUE(!info || info->nodes.empty()) << size;
  }
  EXPECT_FALSE(ParseDiscoveryInfo(std::string("\0\1\0\0", 4) + std::string(200, '\xFF')));
}

TEST(DomainGraph, SeesNodesOfBothLayoutsWithTheirEndpointsUntilTheyGo) {
  auto humble = std::make_unique<TestNode>("humble_node", BuiltInTable(), GidLayout::kHumble);
  TestNode iron("iron_node", BuiltInTable(), GidLayout::kIron);
  const auto writer = humble->participant.CreateWriter(kForcesTopic);
  const auto reader = iron.participant.CreateReader(kForcesTopic);
  DomainGraph graph(TestDomain());
  const auto deadline = [] { return DomainGraph::Clock::now() + std::chrono::seconds(10); };
  graph.WatchUntilComplete(deadline());
  ASSERT_EQ(graph.Nodes().size(), 2u);
  EXPECT_EQ(graph.Nodes()[0].FullName(), "/humble_node");
  EXPECT_EQ(graph.participants().size(), 2u);
  int of_forces = 0;
  for (const auto& [guid, endpoint] : graph.endpoints()) {
    if (endpoint.dds_topic != "rt/forces") continue;
    ++of_forces;
    ASSERT_NE(graph.NodeOf(guid), nullptr);
    EXPECT_EQ(graph.NodeOf(guid)->name, endpoint.is_writer ? "humble_node" : "iron_node");
    if (endpoint.is_writer) {
      EXPECT_EQ(endpoint.depth, 100);
    }
  }
  EXPECT_EQ(of_forces, 2);
  { const auto gone = std::move(humble); }
  EXPECT_TRUE(graph.WatchUntil([&] { return graph.participants().size() == 1; }, deadline()));
  EXPECT_EQ(graph.Nodes().size(), 1u);
}

}  // namespace
}  // namespace palpate::dds
