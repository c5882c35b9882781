// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_graph.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/qos.hpp"
#include "libs/dds/stamp.hpp"
#include "rmw_dds_common/msg/ParticipantEntitiesInfo.hpp"
#include "rmw_dds_common_iron/msg/ParticipantEntitiesInfo.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

template <typename Gid>
void ExpectGid(const Gid& gid, const dds_guid_t& guid) {
  EXPECT_EQ(std::memcmp(gid.data, guid.v, sizeof(guid.v)), 0);
  for (size_t i = sizeof(guid.v); i < sizeof(gid.data); ++i) EXPECT_EQ(gid.data[i], 0);
}

/// What a ROS 2 node would read: the node's name, and whether the GUID of `writer` is among its
/// writers, zeros behind it.
template <typename Info>
void ExpectAnnounced(GidLayout layout) {
  TestNode node("my_node", BuiltInTable(), layout);
  auto writer = node.participant.CreateWriter(kForcesTopic);
  auto reader = node.participant.CreateReader(kMarkersTopic);
  dds_guid_t guid;
  ASSERT_EQ(dds_get_guid(writer.handle(), &guid), DDS_RETCODE_OK);

  TestNode other("observer", BuiltInTable(), layout);
  dds_topic_descriptor_t descriptor = idl::MessageTraits<Info>::Descriptor();
  descriptor.m_typename = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
  const Entity topic(dds_create_topic(other.participant.handle(), &descriptor, "ros_discovery_info",
                                      nullptr, nullptr),
                     "topic");
  TopicSettings latched;
  latched.durability = Durability::kTransientLocal;
  latched.depth = 100;  // without a key, all nodes share one history
  const Entity observer(dds_create_reader(other.participant.handle(), topic.handle(),
                                          ReaderQos(latched).get(), nullptr),
                        "reader");
  bool seen = false;
  other.loop.Attach(observer.handle(), [&] {
    for (const Info& info : Samples<Info>(observer.handle())) {
      for (const auto& entry : Elements(info.node_entities_info_seq)) {
        if (Text(entry.node_name) != "my_node" || entry.writer_gid_seq._length == 0 ||
            entry.reader_gid_seq._length == 0) {
          continue;
        }
        EXPECT_EQ(Text(entry.node_namespace), "/");
        ExpectGid(entry.writer_gid_seq._buffer[0], guid);
        seen = true;
      }
    }
  });
  EXPECT_TRUE(other.WaitFor([&] { return seen; }));
}

TEST(RosGraph, AnnouncesNodeAndEndpointsAsHumbleReadsThem) {
  ExpectAnnounced<idl::rmw_dds_common::ParticipantEntitiesInfo>(GidLayout::kHumble);
}

TEST(RosGraph, AnnouncesNodeAndEndpointsAsIronReadsThem) {
  ExpectAnnounced<idl::rmw_dds_common_iron::ParticipantEntitiesInfo>(GidLayout::kIron);
}

TEST(RosGraph, ANodeIsListedUnderItsNameAndNamespace) {
  ParticipantSettings settings{.domain_id = TestDomain(), .node_name = "my_node"};
  settings.remap = {"__ns:=/left", "__node:=left_node"};
  const Participant node(settings, BuiltInTable());
  TestNode other("observer");
  const Entity topic(
      dds_create_topic(
          other.participant.handle(),
          &idl::MessageTraits<idl::rmw_dds_common::ParticipantEntitiesInfo>::Descriptor(),
          "ros_discovery_info", nullptr, nullptr),
      "topic");
  TopicSettings latched;
  latched.durability = Durability::kTransientLocal;
  latched.depth = 100;
  const Entity observer(dds_create_reader(other.participant.handle(), topic.handle(),
                                          ReaderQos(latched).get(), nullptr),
                        "reader");
  bool seen = false;
  other.loop.Attach(observer.handle(), [&] {
    for (const auto& info :
         Samples<idl::rmw_dds_common::ParticipantEntitiesInfo>(observer.handle())) {
      for (const auto& entry : Elements(info.node_entities_info_seq)) {
        seen =
            seen || (Text(entry.node_name) == "left_node" && Text(entry.node_namespace) == "/left");
      }
    }
  });
  EXPECT_TRUE(other.WaitFor([&] { return seen; }));
}

TEST(RosGraph, ParticipantCarriesTheEnclave) {
  TestNode node("node");
  const Qos qos(dds_create_qos());
  ASSERT_EQ(dds_get_qos(node.participant.handle(), qos.get()), DDS_RETCODE_OK);
  void* data = nullptr;
  size_t size = 0;
  ASSERT_TRUE(dds_qget_userdata(qos.get(), &data, &size));
  EXPECT_THAT(std::string(static_cast<char*>(data), size), testing::StartsWith("enclave=/;"));
  dds_free(data);
}

TEST(NodeLog, EachLineGoesToTheProcessAndToRosout) {
  TestNode node("my_node");
  std::string process_line;
  NodeLog log(node.participant, [&](Severity, std::string_view line) { process_line = line; });
  log.Write(Severity::kWarning, "low light");
  EXPECT_EQ(process_line, "low light");

  TestNode late("late");
  auto reader = late.participant.CreateReader(kRosoutTopic);
  bool seen = false;
  late.loop.Attach(reader, [&] {
    for (const auto& line : reader.Take()) {
      EXPECT_EQ(Text(line.msg), "low light");
      EXPECT_EQ(Text(line.name), "my_node");
      EXPECT_EQ(line.level, rcl_interfaces_msg_Log_Constants_WARN);
      seen = true;
    }
  });
  EXPECT_TRUE(late.WaitFor([&] { return seen; }));
}

TEST(Health, ReportsRatesReasonAndValuesOnBothTopics) {
  TestNode node("my_node"), observer("observer");
  const auto start = HealthReporter::Clock::now();
  HealthReporter reporter(node.participant, "thing", start);
  auto statuses = observer.participant.CreateReader(kComponentStatusTopic, observer.Waker());
  auto diagnostics = observer.participant.CreateReader(kDiagnosticsTopic, observer.Waker());
  ASSERT_TRUE(observer.WaitFor([&] { return statuses.matched() + diagnostics.matched() == 2; }));

  HealthCounts counts;
  counts.received = 20;
  counts.published = 10;
  counts.latencies_s = {0.1, 0.3};
  reporter.Report(Status(StatusCode::kStale, "markers are 3 s old"), counts, {{"domain", "7"}},
                  start + std::chrono::seconds(2));
  bool seen_status = false, seen_diagnostics = false;
  observer.loop.Attach(statuses, [&] {
    for (const auto& status : statuses.Take()) {
      EXPECT_EQ(Text(status.status), "stale");
      EXPECT_EQ(status.input_rate_hz, 10.0);
      EXPECT_EQ(status.output_rate_hz, 5.0);
      EXPECT_DOUBLE_EQ(status.latency_mean_s, 0.2);
      EXPECT_EQ(status.latency_max_s, 0.3);
      seen_status = true;
    }
  });
  observer.loop.Attach(diagnostics, [&] {
    for (const auto& array : diagnostics.Take()) {
      const auto& entry = array.status._buffer[0];
      EXPECT_EQ(entry.level, diagnostic_msgs_msg_DiagnosticStatus_Constants_ERROR);
      EXPECT_EQ(Text(entry.message), "markers are 3 s old");
      EXPECT_EQ(Text(entry.values._buffer[entry.values._length - 1].key), "domain");
      seen_diagnostics = true;
    }
  });
  EXPECT_TRUE(observer.WaitFor([&] { return seen_status && seen_diagnostics; }));
}

}  // namespace
}  // namespace palpate::dds
