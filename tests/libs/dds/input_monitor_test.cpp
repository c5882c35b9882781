// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/input_monitor.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

using testing::HasSubstr;

/// A node with one input, and what it logs.
struct WaitingNode : TestNode {
  WaitingNode() : TestNode("waiting") {
    loop.Attach(forces, [this] { (void)forces.Take(); });
    loop.Every(std::chrono::milliseconds(20), [] {});
    monitor.Expect(forces, "palpate-force-estimation");
  }

  /// Whether a line with `text` comes, within 10 s, after those that were waited for before.
  bool Logs(const std::string& text) {
    return WaitFor([&] {
      while (seen < lines.size()) {
        if (lines[seen++].find(text) != std::string::npos) return true;
      }
      return false;
    });
  }

  std::vector<std::string> lines;
  std::size_t seen = 0;
  NodeLog log{participant, [this](Severity, std::string_view text) { lines.emplace_back(text); }};
  Reader<idl::palpate_msgs::ForceArray> forces = participant.CreateReader(kForcesTopic);
  InputMonitor monitor{participant, loop, log};
};

TEST(InputMonitor, SaysWhatTheReaderWaitsForAndWhenItComesGoesAndComesBack) {
  WaitingNode node;
  ASSERT_TRUE(node.Logs("waiting for /forces: no publisher in domain " +
                        std::to_string(TestDomain()) + "; palpate-force-estimation publishes it"));
  EXPECT_THAT(node.monitor.Waiting(), HasSubstr("/forces"));
  std::optional<TestNode> peer;
  const auto start_peer = [&] {
    peer.emplace("peer");
    return peer->participant.CreateWriter(kForcesTopic);
  };
  {
    auto writer = start_peer();
    ASSERT_TRUE(node.WaitFor([&] { return node.forces.matched() == 1; }));
    ASSERT_TRUE(node.Logs("waiting for /forces: no message within"));
    ASSERT_TRUE(writer.Write(Message<idl::palpate_msgs::ForceArray>()));
    ASSERT_TRUE(node.Logs("/forces: first message"));
    EXPECT_EQ(node.monitor.Waiting(), "");
  }
  peer.reset();
  ASSERT_TRUE(node.Logs("waiting for /forces: no publisher"));
  auto writer = start_peer();
  ASSERT_TRUE(node.Logs("/forces: another publisher appeared: palpate-force-estimation was"));
  ASSERT_TRUE(writer.Write(Message<idl::palpate_msgs::ForceArray>()));
  ASSERT_TRUE(node.Logs("/forces: messages again"));
}

TEST(NodeLog, CountsRepeatedWarnings) {
  TestNode node("node");
  std::vector<std::string> lines;
  NodeLog log(node.participant, [&](Severity, std::string_view text) { lines.emplace_back(text); });
  for (int i = 0; i < 20; ++i) log.WarnRepeatedly("cloud refused", StampText(i * 1'000'000));
  EXPECT_THAT(lines, testing::ElementsAre("cloud refused (stamp 1970-01-01T00:00:00.000Z)"));
}

}  // namespace
}  // namespace palpate::dds
