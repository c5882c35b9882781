// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "libs/dds/qos.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/recording/reader.hpp"
#include "rmw_dds_common/msg/ParticipantEntitiesInfo.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/measured_data.hpp"

/// Decodes, with our IDL, what a real ROS 2 Humble node put on the wire.
namespace palpate::dds {
namespace {

using Bytes = std::string;

std::filesystem::path RecordingFile() {
  return test_support::MeasuredDataFolder() / "ros2/ros2_humble_image_wrench.mcap";
}

/// CDR of every message of the topic, in the order of their log time.
std::vector<Bytes> PayloadsOf(const std::string& topic) {
  const recording::Reader reader(RecordingFile());
  EXPECT_TRUE(recording::Scan(recording::InputFile(RecordingFile())).problems.empty());
  recording::MessageFilter filter;
  filter.wanted = [&](const recording::Channel& channel) { return channel.topic == topic; };
  recording::MessageStream stream = reader.Messages(filter);
  std::vector<Bytes> payloads;
  while (const recording::Message* message = stream.Next()) payloads.emplace_back(message->data);
  EXPECT_TRUE(stream.problems().empty());
  return payloads;
}

/// Reads CDR (with its 4-byte header) as T, by the same code that reads it off the wire.
template <typename T>
Message<T> Decode(const Bytes& cdr) {
  TestNode node("decoder");
  const Entity topic(
      dds_create_topic(node.participant.handle(), &idl::MessageTraits<T>::Descriptor(),
                       "rt/decoded", nullptr, nullptr),
      "topic");
  const Entity writer(
      dds_create_writer(node.participant.handle(), topic.handle(), WriterQos({}).get(), nullptr),
      "writer");
  const Entity reader(
      dds_create_reader(node.participant.handle(), topic.handle(), ReaderQos({}).get(), nullptr),
      "reader");
  // A sample of our own, for its type only.
  EXPECT_EQ(dds_write(writer.handle(), &*Message<T>()), DDS_RETCODE_OK);
  ddsi_serdata* own = nullptr;
  dds_sample_info_t info;
  EXPECT_EQ(dds_takecdr(reader.handle(), &own, 1, &info, DDS_ANY_STATE), 1);
  Bytes padded = cdr;
  padded.resize((cdr.size() + 3) / 4 * 4);
  const ddsrt_iovec_t whole{padded.data(), padded.size()};
  ddsi_serdata* foreign = ddsi_serdata_from_ser_iov(own->type, SDK_DATA, 1, &whole, padded.size());
  Message<T> message;
  EXPECT_TRUE(foreign && ddsi_serdata_to_sample(foreign, &*message, nullptr, nullptr));
  if (foreign) ddsi_serdata_unref(foreign);
  ddsi_serdata_unref(own);
  return message;
}

class RosRecording : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(RecordingFile())) {
      GTEST_SKIP() << "no " << RecordingFile() << " (set PALPATE_DATA_DIR)";
    }
  }
};

TEST_F(RosRecording, EveryWrenchOfHumbleIsReadWithOurIdl) {
  const std::vector<Bytes> payloads = PayloadsOf("rt/force");
  ASSERT_GT(payloads.size(), 10u);
  int64_t last_stamp_ns = 0;
  for (const Bytes& cdr : payloads) {
    const auto wrench = Decode<idl::geometry_msgs::WrenchStamped>(cdr);
    EXPECT_FALSE(Text(wrench->header.frame_id).empty());
    EXPECT_GE(StampNs(wrench->header.stamp), last_stamp_ns);
    last_stamp_ns = StampNs(wrench->header.stamp);
    for (const double value : {wrench->wrench.force.x, wrench->wrench.force.z,
                               wrench->wrench.torque.x, wrench->wrench.torque.z}) {
      EXPECT_LT(std::abs(value), 1e4);
    }
  }
}

TEST_F(RosRecording, NodeNamesOfHumbleAreReadWithOurIdl) {
  const std::vector<Bytes> payloads = PayloadsOf("ros_discovery_info");
  ASSERT_FALSE(payloads.empty());
  size_t named_count = 0;
  for (const Bytes& cdr : payloads) {
    const auto info = Decode<idl::rmw_dds_common::ParticipantEntitiesInfo>(cdr);
    for (const auto& node : Elements(info->node_entities_info_seq)) {
      EXPECT_EQ(Text(node.node_namespace).substr(0, 1), "/");
      named_count += Text(node.node_name).empty() ? 0 : 1;
    }
  }
  EXPECT_GE(named_count, 1u);
}

}  // namespace
}  // namespace palpate::dds
