// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/node.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "idl/message_traits.hpp"
#include "libs/core/file.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"
#include "tests/components/recorder/live/running_recorder.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recorder {
namespace {

using dds::TestNode;
using test_support::TestFolder;
using testing::Contains;
using testing::HasSubstr;

/// The test's node waits with its own loop; matches are seen within this time.
void WatchMatches(TestNode& node) {
  node.loop.Every(std::chrono::milliseconds(5), [] {});
}

template <typename Writer>
void Send(Writer& writer, int count) {
  for (int i = 0; i < count; ++i) {
    dds::Message<idl::palpate_msgs::MarkerArray3> message;
    dds::SetHeader(message->header, 1'000'000 * i, "robot");
    message->counter = static_cast<uint64_t>(i);
    ASSERT_TRUE(writer.Write(message));
  }
}

TEST(RecorderNode, RecordsEachMessageOfAWriterWithTheDefinitionOfItsType) {
  const TestFolder folder;
  TestNode robot("robot");
  WatchMatches(robot);
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  RunningRecorder recorder(folder / "run.mcap");
  ASSERT_TRUE(robot.WaitFor([&] { return markers.matched() > 0; }));
  Send(markers, 200);
  EXPECT_EQ(recorder.Stop(), "");
  const recording::Reader reader(folder / "run.mcap");
  recording::MessageFilter filter;
  filter.wanted = [](const recording::Channel& channel) {
    return channel.topic == "/perception/markers";
  };
  recording::MessageStream stream = reader.Messages(filter);
  uint64_t expected = 0;
  while (const recording::Message* message = stream.Next()) {
    const recording::Channel& channel = reader.contents().channels.at(message->channel_id);
    const recording::Schema& schema = reader.SchemaOf(channel);
    ASSERT_EQ(schema.name, "palpate_msgs/msg/MarkerArray3");
    ASSERT_EQ(schema.encoding, "ros2msg");
    const auto definitions = recording::ParseRos2msg(schema.name, schema.data);
    EXPECT_EQ(recording::UnsignedField(message->data, definitions.at("palpate_msgs/MarkerArray3"),
                                       "counter", definitions),
              expected++);
    EXPECT_GE(message->log_time_ns, message->publish_time_ns);
    EXPECT_THAT(channel.metadata.at("offered_qos_profiles"), HasSubstr("reliability: 1"));
  }
  EXPECT_EQ(expected, 200u);
}

TEST(RecorderNode, ALatchedMessageFromBeforeItsStartIsRecorded) {
  const TestFolder folder;
  TestNode robot("robot");
  WatchMatches(robot);
  auto mesh = robot.participant.CreateWriter(dds::kMeshTopic);
  ASSERT_TRUE(mesh.Write(dds::Message<idl::palpate_msgs::Mesh>()));
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  RunningRecorder recorder(folder / "run.mcap");
  ASSERT_TRUE(robot.WaitFor([&] { return mesh.matched() > 0 && markers.matched() > 0; }));
  ASSERT_TRUE(mesh.WaitUntilReceived(std::chrono::seconds(5)));
  EXPECT_EQ(recorder.Stop(), "");
  EXPECT_THAT(TopicsIn(folder / "run.mcap"), Contains("/robot/mesh"));
}

TEST(RecorderNode, ChoosesTopicsByNameAndNeverRecordsItself) {
  const TestFolder folder;
  TestNode robot("robot");
  WatchMatches(robot);
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  auto mesh_state = robot.participant.CreateWriter(dds::kMeshStateTopic);
  RecordPlan plan = RunningRecorder::PlanFor(folder / "run.mcap");
  plan.choice = {{"/perception/*", "/robot/*", "/rosout"}, {"/robot/mesh*"}};
  RunningRecorder recorder({}, plan);
  ASSERT_TRUE(robot.WaitFor([&] { return markers.matched() > 0; }));
  Send(markers, 3);
  ASSERT_TRUE(mesh_state.Write(dds::Message<idl::palpate_msgs::MeshState>()));
  EXPECT_EQ(recorder.Stop(), "");
  EXPECT_THAT(
      TopicsIn(folder / "run.mcap"),
      testing::ElementsAre("/perception/markers", "/perception/markers", "/perception/markers"));
}

TEST(RecorderNode, ATopicWhoseTypeChangesIsRecordedWithBothTypes) {
  const TestFolder folder;
  TestNode robot("robot");
  TestNode other("other");
  WatchMatches(robot);
  const auto& wrench = idl::MessageTraits<idl::geometry_msgs::WrenchStamped>::Descriptor();
  const auto& joints = idl::MessageTraits<idl::sensor_msgs::JointState>::Descriptor();
  RunningRecorder recorder(folder / "run.mcap");
  PlainWriter first(robot, wrench, "rt/changing", {});
  ASSERT_TRUE(robot.WaitFor([&] { return first.is_read(); }));
  ASSERT_TRUE(first.Write(&*dds::Message<idl::geometry_msgs::WrenchStamped>()));
  PlainWriter second(other, joints, "rt/changing", {});
  ASSERT_TRUE(robot.WaitFor([&] { return second.is_read(); }));
  ASSERT_TRUE(second.Write(&*dds::Message<idl::sensor_msgs::JointState>()));
  EXPECT_EQ(recorder.Stop(), "");
  const recording::Reader reader(folder / "run.mcap");
  std::vector<std::string> types;
  recording::MessageStream stream = reader.Messages();
  while (const recording::Message* message = stream.Next()) {
    const auto& channel = reader.contents().channels.at(message->channel_id);
    EXPECT_EQ(channel.topic, "/changing");
    types.push_back(reader.SchemaOf(channel).name);
  }
  EXPECT_THAT(
      types, testing::ElementsAre("geometry_msgs/msg/WrenchStamped", "sensor_msgs/msg/JointState"));
}

TEST(RecorderNode, AWriterThatOffersLessThanAnotherIsRecordedToo) {
  const TestFolder folder;
  TestNode robot("robot");
  TestNode driver("driver");
  WatchMatches(robot);
  const auto& wrench = idl::MessageTraits<idl::geometry_msgs::WrenchStamped>::Descriptor();
  dds::TopicSettings reliable;
  reliable.durability = dds::Durability::kTransientLocal;
  dds::TopicSettings best_effort;
  best_effort.reliability = dds::Reliability::kBestEffort;
  RunningRecorder recorder(folder / "run.mcap");
  PlainWriter first(robot, wrench, "rt/wrench", reliable);
  ASSERT_TRUE(robot.WaitFor([&] { return first.is_read(); }));
  PlainWriter second(driver, wrench, "rt/wrench", best_effort);
  ASSERT_TRUE(robot.WaitFor([&] { return first.is_read() && second.is_read(); }));
  const dds::Message<idl::geometry_msgs::WrenchStamped> message;
  ASSERT_TRUE(first.Write(&*message));
  ASSERT_TRUE(second.Write(&*message));
  EXPECT_EQ(recorder.Stop(), "");
  EXPECT_EQ(TopicsIn(folder / "run.mcap").size(), 2u);
}

TEST(RecorderNode, AMessageOf30MBIsRecorded) {
  const TestFolder folder;
  TestNode camera("camera");
  WatchMatches(camera);
  auto depth = camera.participant.CreateWriter(dds::kDepthImageTopic);
  RunningRecorder recorder(folder / "run.mcap");
  ASSERT_TRUE(camera.WaitFor([&] { return depth.matched() > 0; }));
  dds::Message<idl::sensor_msgs::Image> image;
  dds::Resize(image->data, 30'000'000);
  ASSERT_TRUE(depth.Write(image));
  EXPECT_EQ(recorder.Stop(), "");
  EXPECT_GT(std::filesystem::file_size(folder / "run.mcap"), 30'000'000u);
  EXPECT_THAT(TopicsIn(folder / "run.mcap"), testing::ElementsAre("/camera/depth/image_raw"));
}

TEST(RecorderNode, AnErrorOnDiagnosticsSavesTheLastSecondsBesideItsReason) {
  const TestFolder folder;
  TestNode robot("robot");
  WatchMatches(robot);
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  auto diagnostics = robot.participant.CreateWriter(dds::kDiagnosticsTopic);
  RecordPlan plan = RunningRecorder::PlanFor(folder / "run.mcap");
  plan.only_recent = true;
  RunningRecorder recorder({}, plan);
  ASSERT_TRUE(robot.WaitFor([&] { return markers.matched() > 0 && diagnostics.matched() > 1; }));
  Send(markers, 5);
  dds::Message<idl::diagnostic_msgs::DiagnosticArray> array;
  dds::Resize(array->status, 1);
  array->status._buffer[0].level = diagnostic_msgs_msg_DiagnosticStatus_Constants_ERROR;
  dds::SetText(array->status._buffer[0].name, "perception");
  dds::SetText(array->status._buffer[0].message, "no depth image for 3 s");
  ASSERT_TRUE(diagnostics.Write(array));
  // The same error again is the same event.
  ASSERT_TRUE(diagnostics.Write(array));
  ASSERT_TRUE(robot.WaitFor([&] { return !recorder.node().files().snapshots.empty(); }));
  EXPECT_EQ(recorder.Stop(), "");
  const std::vector<std::filesystem::path> saved = recorder.node().files().snapshots;
  ASSERT_EQ(saved.size(), 1u);
  EXPECT_THAT(saved[0].filename().string(), testing::StartsWith("run_error_"));
  std::filesystem::path reason = saved[0];
  EXPECT_EQ(ReadFile(reason.replace_extension(".txt")), "perception: no depth image for 3 s\n");
  const std::vector<std::string> topics = TopicsIn(saved[0]);
  EXPECT_EQ(std::count(topics.begin(), topics.end(), "/perception/markers"), 5);
  EXPECT_FALSE(std::filesystem::exists(folder / "run.mcap"));
}

TEST(RecorderNode, ASnapshotIsSavedOnRequestBesideTheRecording) {
  const TestFolder folder;
  TestNode robot("robot");
  WatchMatches(robot);
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  RunningRecorder recorder(folder / "run.mcap");
  ASSERT_TRUE(robot.WaitFor([&] { return markers.matched() > 0; }));
  Send(markers, 5);
  recorder.node().RequestSnapshot();
  ASSERT_TRUE(robot.WaitFor([&] { return !recorder.node().files().snapshots.empty(); }));
  EXPECT_EQ(recorder.Stop(), "");
  EXPECT_EQ(TopicsIn(recorder.node().files().snapshots[0]), TopicsIn(folder / "run.mcap"));
}

TEST(RecorderNode, LossesAreCountedByTheMessagesOwnCounters) {
  const TestFolder folder;
  TestNode robot("robot");
  WatchMatches(robot);
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  std::atomic<uint64_t> lost = 0;
  RecordPlan plan = RunningRecorder::PlanFor(folder / "run.mcap");
  plan.show = [&](const RecorderStatus& status) {
    for (const TopicRow& row : status.topics) {
      if (row.topic == "/perception/markers") lost = row.lost;
    }
  };
  RunningRecorder recorder({}, plan);
  ASSERT_TRUE(robot.WaitFor([&] { return markers.matched() > 0; }));
  for (const uint64_t counter : {1, 2, 5, 6, 10}) {
    dds::Message<idl::palpate_msgs::MarkerArray3> message;
    message->counter = counter;
    ASSERT_TRUE(markers.Write(message));
  }
  EXPECT_EQ(recorder.Stop(), "");
  EXPECT_EQ(lost, 5u);
}

}  // namespace
}  // namespace palpate::recorder
