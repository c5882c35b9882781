// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <dds/dds.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

using idl::palpate_msgs::ForceArray;
using idl::palpate_msgs::Mesh;

Message<Mesh> BigMesh(size_t node_count) {
  Message<Mesh> mesh;
  SetHeader(mesh->header, 5, "robot");
  SetText(mesh->robot, "diamond");
  std::vector<double> nodes_m(3 * node_count);
  for (size_t i = 0; i < nodes_m.size(); ++i) nodes_m[i] = 0.001 * static_cast<double>(i);
  SetNumbers(mesh->nodes_m, nodes_m.data(), nodes_m.size());
  return mesh;
}

Message<ForceArray> Forces(uint64_t counter) {
  Message<ForceArray> forces;
  SetHeader(forces->header, 1'500'000'000, "robot");
  forces->counter = counter;
  SetText(forces->status, "ok");
  Resize(forces->forces, 1);
  SetText(forces->forces._buffer[0].name, "tip");
  forces->forces._buffer[0].force_n = {0.1, -0.2, 0.3};
  return forces;
}

TEST(Publish, AMessageArrivesAsItWasSent) {
  TestNode sender("sender"), receiver("receiver");
  auto writer = sender.participant.CreateWriter(kForcesTopic, sender.Waker());
  auto reader = receiver.participant.CreateReader(kForcesTopic);
  ASSERT_TRUE(sender.WaitFor([&] { return writer.matched() == 1; }));
  ASSERT_TRUE(writer.Write(Forces(42)));

  uint64_t counter = 0;
  int64_t stamp_ns = 0;
  std::string name;
  double force_z_N = 0.0;
  receiver.loop.Attach(reader, [&] {
    for (const ForceArray& forces : reader.Take()) {
      counter = forces.counter;
      stamp_ns = StampNs(forces.header.stamp);
      name = Text(forces.forces._buffer[0].name);
      force_z_N = forces.forces._buffer[0].force_n.z;
    }
  });
  ASSERT_TRUE(receiver.WaitFor([&] { return counter == 42; }));
  EXPECT_EQ(stamp_ns, 1'500'000'000);
  EXPECT_EQ(name, "tip");
  EXPECT_EQ(force_z_N, 0.3);
  EXPECT_EQ(writer.sent_count(), 1u);
}

TEST(Publish, EachMessageTellsWhenItWasSent) {
  TestNode sender("sender"), receiver("receiver");
  auto writer = sender.participant.CreateWriter(kForcesTopic, sender.Waker());
  auto reader = receiver.participant.CreateReader(kForcesTopic);
  ASSERT_TRUE(sender.WaitFor([&] { return writer.matched() == 1; }));
  std::vector<int64_t> before_ns;
  std::vector<int64_t> sent_ns;
  receiver.loop.Attach(reader, [&] {
    const auto samples = reader.Take();
    for (auto sample = samples.begin(); sample != samples.end(); ++sample) {
      EXPECT_EQ((*sample).counter, sent_ns.size());
      sent_ns.push_back(sample.sent_ns());
    }
  });
  for (uint64_t counter = 0; counter < 3; ++counter) {
    before_ns.push_back(WallClockNs());
    ASSERT_TRUE(writer.Write(Forces(counter)));
  }
  const int64_t after_ns = WallClockNs();
  ASSERT_TRUE(receiver.WaitFor([&] { return sent_ns.size() == 3; }));
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_GE(sent_ns[i], before_ns[i]);
    EXPECT_LE(sent_ns[i], i + 1 < 3 ? before_ns[i + 1] : after_ns);
  }
}

TEST(Publish, ALateJoinerGetsTheBigLatchedMesh) {
  constexpr size_t kNodeCount = 100'000;  // 2.4 MB
  TestNode sender("sender");
  auto writer = sender.participant.CreateWriter(kMeshTopic);
  ASSERT_TRUE(writer.Write(BigMesh(kNodeCount)));

  TestNode late("late");
  auto reader = late.participant.CreateReader(kMeshTopic);
  size_t node_count = 0;
  double last_m = 0.0;
  late.loop.Attach(reader, [&] {
    for (const Mesh& mesh : reader.Take()) {
      node_count = mesh.nodes_m._length / 3;
      last_m = mesh.nodes_m._buffer[mesh.nodes_m._length - 1];
    }
  });
  ASSERT_TRUE(late.WaitFor([&] { return node_count > 0; }));
  EXPECT_EQ(node_count, kNodeCount);
  EXPECT_EQ(last_m, 0.001 * static_cast<double>(3 * kNodeCount - 1));
}

TEST(Publish, PartnersWithIncompatibleQosAreTurnedAwayAndCounted) {
  TestNode sender("sender", TableWith("/forces", [](TopicSettings& topic) {
                    topic.reliability = Reliability::kBestEffort;
                  }));
  TestNode receiver("receiver");
  auto writer = sender.participant.CreateWriter(kForcesTopic, sender.Waker());
  auto reader = receiver.participant.CreateReader(kForcesTopic, receiver.Waker());
  ASSERT_TRUE(sender.WaitFor([&] { return writer.counters().incompatible_qos == 1; }));
  ASSERT_TRUE(receiver.WaitFor([&] { return reader.counters().incompatible_qos == 1; }));
  EXPECT_EQ(PolicyName(reader.counters().last_incompatible_policy), "reliability");
  EXPECT_EQ(writer.counters().last_incompatible_policy, uint32_t{DDS_RELIABILITY_QOS_POLICY_ID});
  EXPECT_EQ(writer.matched(), 0u);
}

TEST(Publish, AMissedDeadlineIsCountedOnBothSides) {
  const TopicTable table =
      TableWith("/forces", [](TopicSettings& topic) { topic.deadline_s = 0.05; });
  TestNode sender("sender", table), receiver("receiver", table);
  auto writer = sender.participant.CreateWriter(kForcesTopic, sender.Waker());
  auto reader = receiver.participant.CreateReader(kForcesTopic, receiver.Waker());
  ASSERT_TRUE(sender.WaitFor([&] { return writer.matched() == 1; }));
  ASSERT_TRUE(writer.Write(Forces(0)));
  EXPECT_TRUE(sender.WaitFor([&] { return writer.counters().deadline_missed >= 1; }));
  EXPECT_TRUE(receiver.WaitFor([&] { return reader.counters().deadline_missed >= 1; }));
}

TEST(Publish, AReaderThatLeavesIsNoLongerMatched) {
  TestNode sender("sender");
  auto writer = sender.participant.CreateWriter(kForcesTopic, sender.Waker());
  {
    TestNode receiver("receiver");
    auto reader = receiver.participant.CreateReader(kForcesTopic);
    ASSERT_TRUE(sender.WaitFor([&] { return writer.matched() == 1; }));
  }
  EXPECT_TRUE(sender.WaitFor([&] { return writer.matched() == 0; }));
}

TEST(Publish, ShutdownInMidMessageIsClean) {
  TestNode sender("sender");
  auto writer = sender.participant.CreateWriter(kMeshTopic);
  std::atomic<bool> stop = false;
  std::atomic<int> sent = 0;
  const auto mesh = BigMesh(20'000);
  std::thread sending([&] {
    while (!stop) sent += writer.Write(mesh) ? 1 : 0;
  });
  for (int round = 0; round < 5; ++round) {
    TestNode receiver("receiver");
    auto reader = receiver.participant.CreateReader(kMeshTopic);
    int taken = 0;
    receiver.loop.Attach(reader, [&] {
      for (const Mesh& message : reader.Take()) taken += message.nodes_m._length > 0 ? 1 : 0;
    });
    EXPECT_TRUE(receiver.WaitFor([&] { return taken > 0; }));
  }
  stop = true;
  sending.join();
  EXPECT_GT(sent, 0);
}

TEST(Publish, RefusesATopicWhoseTypeTheTableGivesDifferently) {
  TestNode node("node", TableWith("/forces", [](TopicSettings& topic) {
                  topic.type = "palpate_msgs/msg/Force";
                }));
  EXPECT_THROW(node.participant.CreateWriter(kForcesTopic), InputError);
}

/// CYCLONEDDS_URI as long as this lives.
class CycloneUri {
 public:
  explicit CycloneUri(const char* uri) {
    if (const char* old = std::getenv("CYCLONEDDS_URI")) old_ = old;
    setenv("CYCLONEDDS_URI", uri, 1);
  }
  ~CycloneUri() { old_ ? setenv("CYCLONEDDS_URI", old_->c_str(), 1) : unsetenv("CYCLONEDDS_URI"); }

 private:
  std::optional<std::string> old_;
};

std::string StartFailure(const char* cyclone_uri, uint32_t domain) {
  const CycloneUri uri(cyclone_uri);
  try {
    Participant participant({.domain_id = domain, .node_name = "node"}, BuiltInTable());
    return "started";
  } catch (const RunError& error) {
    return error.what();
  }
}

TEST(Publish, SaysWhyAParticipantCannotBeMade) {
  EXPECT_THAT(StartFailure("<NoSuchElement/>", 199), testing::HasSubstr("domain 199"));
}

TEST(Publish, TheConfigurationsThatWeShipAreUnderstood) {
  const std::string folder = "file://" PALPATE_SOURCE_DIR "/config/cyclonedds/";
  EXPECT_EQ(StartFailure((folder + "one_host.xml").c_str(), 198), "started");
  EXPECT_EQ(StartFailure((folder + "lan.xml").c_str(), 197), "started");
  EXPECT_EQ(StartFailure((folder + "default.xml").c_str(), 196), "started");
  EXPECT_EQ(StartFailure((folder + "jumbo_lan.xml").c_str(), 193), "started");
  EXPECT_EQ(StartFailure((folder + "lossy_link.xml").c_str(), 192), "started");
}

/// Two participants in one domain, one of which goes first; whose settings the domain has.
std::string JoinTwice(const char* cyclone_uri, uint32_t domain) {
  const CycloneUri uri(cyclone_uri);
  const auto settings = ApplyDomainSettings(domain);
  Participant first({.domain_id = domain, .node_name = "first"}, BuiltInTable());
  { Participant second({.domain_id = domain, .node_name = "second"}, BuiltInTable()); }
  // Works on after the second has gone.
  auto writer = first.CreateWriter(kForcesTopic);
  EXPECT_TRUE(writer.Write(Message<idl::palpate_msgs::ForceArray>()));
  return settings ? "built-in" : "by CYCLONEDDS_URI";
}

TEST(Publish, BuiltInSettingsHoldWhereTheUserGivesNone) {
  EXPECT_EQ(JoinTwice("", 195), "built-in");
  EXPECT_EQ(JoinTwice("file://" PALPATE_SOURCE_DIR "/config/cyclonedds/one_host.xml", 195),
            "by CYCLONEDDS_URI");
  EXPECT_EQ(JoinTwice("", 195), "built-in");
}

TEST(Publish, SettingsThatContradictEachOtherAreRefusedAtTheStart) {
  const CycloneUri uri(
      "<Domain><SharedMemory><Enable>true</Enable></SharedMemory><Security/></Domain>");
  EXPECT_THROW(Participant({.domain_id = 191, .node_name = "node"}, BuiltInTable()), InputError);
}

TEST(Publish, TheEnvironmentNamesTheInterface) {
  const std::string lan = "file://" PALPATE_SOURCE_DIR "/config/cyclonedds/lan.xml";
  setenv("PALPATE_INTERFACE", "lo", 1);
  EXPECT_EQ(StartFailure(lan.c_str(), 190), "started");
  EXPECT_EQ(JoinTwice("", 189), "built-in");
  setenv("PALPATE_INTERFACE", "127.0.0.1", 1);
  EXPECT_EQ(StartFailure(lan.c_str(), 188), "started");
  setenv("PALPATE_INTERFACE", "no_such_one", 1);
  EXPECT_THAT(StartFailure(lan.c_str(), 187), testing::HasSubstr("network interface"));
  unsetenv("PALPATE_INTERFACE");
}

TEST(Publish, ADomainThatWasJoinedWithoutThemKeepsItsSettings) {
  const CycloneUri uri("");
  const Entity other(dds_create_participant(194, nullptr, nullptr), "a participant");
  EXPECT_EQ(ApplyDomainSettings(194), nullptr);
  Participant participant({.domain_id = 194, .node_name = "node"}, BuiltInTable());
  EXPECT_GT(participant.handle(), 0);
}

TEST(Publish, BuiltInSettingsLetOtherHostsIn) {
  const std::string_view settings = BuiltInDomainSettings();
  EXPECT_THAT(settings, testing::HasSubstr("<AllowMulticast>spdp</AllowMulticast>"));
  EXPECT_THAT(settings, testing::HasSubstr("<NackDelay>10ms</NackDelay>"));
  for (const char* only_here : {"<Interfaces>", "NetworkInterface", "<Peers>", "MaxMessageSize"}) {
    EXPECT_THAT(settings, testing::Not(testing::HasSubstr(only_here)));
  }
}

}  // namespace
}  // namespace palpate::dds
