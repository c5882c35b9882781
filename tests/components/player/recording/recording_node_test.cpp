// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/recording_node.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <set>

#include "Gripper.h"
#include "libs/dds/stamp.hpp"
#include "tests/components/player/recording/running_playback.hpp"
#include "tests/components/recorder/live/running_recorder.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::player {
namespace {

using dds::TestNode;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kFast = std::numeric_limits<double>::infinity();

/// Ten states, 0.1 s apart, after a latched mesh.
std::filesystem::path WriteStates(const TestFolder& folder) {
  const auto file = folder / "states.mcap";
  SampleFile sample(file);
  sample.Write(sample.Channel("/test/mesh", kLatchedQos), 0.0, "mesh");
  const auto state = sample.Channel("/test/state", kVolatileQos);
  for (int i = 0; i < 10; ++i) sample.Write(state, 0.1 * i, std::to_string(i));
  return file;
}

class RecordingNodeTest : public testing::Test {
 protected:
  RecordingNodeTest() {
    listener_.loop.Every(std::chrono::milliseconds(5), [] {});
  }

  bool WaitForEnd(const RunningPlayback& player) {
    return listener_.WaitFor([&] { return player.finished(); });
  }

  const TestFolder folder_;
  TestNode listener_{"listener"};
};

const std::vector<std::string> kAllStates{"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"};

TEST_F(RecordingNodeTest, ReadersThatWaitGetEveryMessage) {
  TextListener states(listener_, "/test/state");
  TextListener meshes(listener_, "/test/mesh");
  RunningPlayback player({WriteStates(folder_)}, {.rate = kFast});
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_EQ(player.Join(), "");
  EXPECT_EQ(states.texts(), kAllStates);
  EXPECT_THAT(meshes.texts(), ElementsAre("mesh"));
}

TEST_F(RecordingNodeTest, ALateJoinerGetsWhatIsLatchedAlsoFromBeforeTheStart) {
  TextListener states(listener_, "/test/state");
  RunningPlayback player({WriteStates(folder_)}, {.paused = true, .start_s = 0.45});
  ASSERT_TRUE(listener_.WaitFor([&] { return states.writers() > 0; }));
  TextListener late(listener_, "/test/mesh", true);
  EXPECT_TRUE(listener_.WaitFor([&] { return late.texts().size() == 1; }));
  EXPECT_TRUE(states.texts().empty());
  player.node().Ask(Request::kPauseOrResume);
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_THAT(states.texts(), ElementsAre("5", "6", "7", "8", "9"));
}

TEST_F(RecordingNodeTest, EndsWhereItIsToldAndBeginsAgain) {
  TextListener states(listener_, "/test/state");
  RunningPlayback player({WriteStates(folder_)},
                         {.rate = kFast, .loop = true, .start_s = 0.15, .end_s = 0.35});
  ASSERT_TRUE(listener_.WaitFor([&] { return states.texts().size() >= 5; }));
  const std::vector<std::string> texts = states.texts();
  EXPECT_THAT(std::vector(texts.begin(), texts.begin() + 5), ElementsAre("2", "3", "2", "3", "2"));
}

TEST_F(RecordingNodeTest, WhilePausedEachStepPlaysTheAskedNumberOfMessagesOfOneTopic) {
  TextListener states(listener_, "/test/state");
  RunningPlayback player({WriteStates(folder_)},
                         {.paused = true, .step_topic = "/test/state", .step_count = 2});
  ASSERT_TRUE(listener_.WaitFor([&] { return states.writers() > 0; }));
  player.node().Ask(Request::kStep);
  ASSERT_TRUE(listener_.WaitFor([&] { return states.texts().size() == 2; }));
  player.node().Ask(Request::kForward);  // to the end of the recording
  player.node().Ask(Request::kBack);     // and to its beginning
  player.node().Ask(Request::kStep);
  ASSERT_TRUE(listener_.WaitFor([&] { return states.texts().size() == 4; }));
  EXPECT_THAT(states.texts(), ElementsAre("0", "1", "0", "1"));
}

TEST_F(RecordingNodeTest, TheRateChangesInBetween) {
  PlayerConfig config;
  config.publish_clock = true;
  TextListener states(listener_, "/test/state");
  RunningPlayback player({WriteStates(folder_)}, {.rate = 0.02}, config);
  ASSERT_TRUE(listener_.WaitFor([&] { return states.texts().size() == 1; }));
  for (int i = 0; i < 60; ++i) player.node().Ask(Request::kFaster);
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_EQ(states.texts(), kAllStates);
}

TEST_F(RecordingNodeTest, NamesAreBelowTheNamespaceAndRenamed) {
  PlayerConfig config;
  config.dds.remap = {"__ns:=/left", "/test/mesh:=/mesh"};
  TextListener states(listener_, "/left/test/state");
  TextListener meshes(listener_, "/mesh");
  RunningPlayback player({WriteStates(folder_)}, {.rate = kFast}, config);
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_EQ(states.texts(), kAllStates);
  EXPECT_THAT(meshes.texts(), ElementsAre("mesh"));
}

TEST_F(RecordingNodeTest, ARuleForATopicThatIsNotThereIsRefused) {
  PlayerConfig config;
  config.dds.remap = {"/test/stade:=/state"};
  EXPECT_THROW(RunningPlayback({WriteStates(folder_)}, {}, config), InputError);
}

/// Publishes texts on a topic, as a live process does.
class LiveWriter {
 public:
  LiveWriter(TestNode& node, const std::string& ros_topic)
      : writer_(node.participant.CreateRawWriter(
            {.dds_topic = "rt" + ros_topic, .dds_type = "std_msgs::msg::dds_::String_"})) {}

 private:
  std::unique_ptr<dds::RawWriter> writer_;
};

TEST_F(RecordingNodeTest, WhatLiveWritersPublishIsRefused) {
  TestNode robot("robot");
  const LiveWriter live(robot, "/test/state");
  TextListener meshes(listener_, "/test/mesh");
  RunningPlayback player({WriteStates(folder_)}, {.rate = kFast});
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_THAT(player.Join(), HasSubstr("--exclude /test/state)"));
  EXPECT_TRUE(meshes.texts().empty());
}

TEST_F(RecordingNodeTest, BesideLiveWritersItPlaysWhereThatIsAskedFor) {
  TestNode robot("robot");
  const LiveWriter live(robot, "/test/state");
  TextListener states(listener_, "/test/state");
  RunningPlayback player({WriteStates(folder_)}, {.rate = kFast, .beside_writers = true});
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_EQ(player.Join(), "");
  EXPECT_EQ(states.texts(), kAllStates);
}

TEST_F(RecordingNodeTest, ATopicFallsSilentWhenALiveWriterAppears) {
  TextListener states(listener_, "/test/state");
  TextListener meshes(listener_, "/test/mesh");
  RunningPlayback player({WriteStates(folder_)}, {.rate = kFast, .loop = true});
  ASSERT_TRUE(listener_.WaitFor([&] { return !states.texts().empty(); }));
  TestNode robot("robot");
  const LiveWriter live(robot, "/test/state");
  std::size_t heard = 0;
  std::size_t meshes_then = 0;
  // Silent: many meshes come, and no state between them.
  ASSERT_TRUE(listener_.WaitFor([&] {
    const std::size_t now = states.texts().size();
    if (now != heard) {
      heard = now;
      meshes_then = meshes.texts().size();
    }
    return meshes.texts().size() > meshes_then + 5;
  }));
}

TEST_F(RecordingNodeTest, GivesUpWhereNobodyReads) {
  PlayerConfig config;
  config.reader_deadline_s = 0.05;
  RunningPlayback player({WriteStates(folder_)}, {.rate = kFast}, config);
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_THAT(player.Join(), HasSubstr("no reader of any topic of the recording within 0.05 s"));
}

TEST_F(RecordingNodeTest, TheClockIsThatOfTheRecording) {
  PlayerConfig config;
  config.publish_clock = true;
  TextListener states(listener_, "/test/state");
  auto clock = listener_.participant.CreateReader(dds::kClockTopic);
  std::vector<std::int64_t> times_ns;
  listener_.loop.Attach(clock, [&] {
    for (const auto& message : clock.Take()) times_ns.push_back(dds::StampNs(message.clock));
  });
  RunningPlayback player({WriteStates(folder_)}, {}, config);
  ASSERT_TRUE(WaitForEnd(player));
  ASSERT_GT(times_ns.size(), 5u);
  EXPECT_GE(times_ns.front(), kSampleStart_ns);
  EXPECT_LE(times_ns.back(), kSampleStart_ns + kSecond_ns);
  EXPECT_TRUE(std::is_sorted(times_ns.begin(), times_ns.end()));
}

TEST_F(RecordingNodeTest, InstancesOfAKeyedTypeComeBackToALateJoiner) {
  dds::TopicSettings latched;
  latched.durability = dds::Durability::kTransientLocal;
  const auto file = folder_ / "grippers.mcap";
  {
    recorder::RunningRecorder recorder(file);
    TestNode robot("robot");
    robot.loop.Every(std::chrono::milliseconds(5), [] {});
    recorder::PlainWriter writer(robot, lab_Gripper_desc, "gripper", latched);
    ASSERT_TRUE(robot.WaitFor([&] { return writer.is_read(); }));
    for (const int id : {1, 2, 1, 3}) {
      lab_Gripper gripper{};
      gripper.id = id;
      ASSERT_TRUE(writer.Write(&gripper));
    }
    ASSERT_TRUE(writer.WaitUntilReceived());
    EXPECT_EQ(recorder.Stop(), "");
  }
  PlayerConfig config;
  config.wait_for_readers = false;
  RunningPlayback player({file}, {.rate = kFast, .loop = true}, config);
  const dds::Entity topic(dds_create_topic(listener_.participant.handle(), &lab_Gripper_desc,
                                           "gripper", nullptr, nullptr),
                          "topic");
  const dds::Entity reader(dds_create_reader(listener_.participant.handle(), topic.handle(),
                                             dds::ReaderQos(latched).get(), nullptr),
                           "reader");
  std::set<int> ids;
  EXPECT_TRUE(listener_.WaitFor([&] {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader.handle(), &sample, &info, 1, 1) > 0) {
      if (info.valid_data) ids.insert(static_cast<lab_Gripper*>(sample)->id);
      dds_return_loan(reader.handle(), &sample, 1);
      sample = nullptr;
    }
    return ids == std::set<int>{1, 2, 3};
  }));
}

/// Markers from a robot; `stamps` in ns.
std::filesystem::path RecordMarkers(const TestFolder& folder, int count) {
  const auto file = folder / "markers.mcap";
  TestNode robot("robot");
  robot.loop.Every(std::chrono::milliseconds(5), [] {});
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  recorder::RunningRecorder recorder(file);
  EXPECT_TRUE(robot.WaitFor([&] { return markers.matched() > 0; }));
  for (int i = 0; i < count; ++i) {
    dds::Message<idl::palpate_msgs::MarkerArray3> message;
    dds::SetHeader(message->header, 1'000'000 * i, "robot");
    message->counter = static_cast<std::uint64_t>(i);
    EXPECT_TRUE(markers.Write(message));
  }
  EXPECT_EQ(recorder.Stop(), "");
  return file;
}

TEST_F(RecordingNodeTest, InStepsEachFrameWaitsForTheAnswerToTheLast) {
  const auto file = RecordMarkers(folder_, 20);
  auto forces = listener_.participant.CreateWriter(dds::kForcesTopic);
  auto markers = listener_.participant.CreateReader(dds::kMarkersTopic);
  std::vector<std::uint64_t> counters;
  listener_.loop.Attach(markers, [&] {
    std::size_t taken = 0;
    for (const auto& message : markers.Take()) {
      counters.push_back(message.counter);
      dds::Message<idl::palpate_msgs::ForceArray> answer;
      answer->header.stamp = message.header.stamp;
      EXPECT_TRUE(forces.Write(answer));
      ++taken;
    }
    EXPECT_LE(taken, 1u);
  });
  RunningPlayback player({file}, {.step = true});
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_EQ(player.Join(), "");
  ASSERT_EQ(counters.size(), 20u);
  for (std::size_t i = 0; i < counters.size(); ++i) EXPECT_EQ(counters[i], i);
}

TEST_F(RecordingNodeTest, InStepsItGivesUpWithoutAnswer) {
  const auto file = RecordMarkers(folder_, 2);
  auto forces = listener_.participant.CreateWriter(dds::kForcesTopic);
  auto markers = listener_.participant.CreateReader(dds::kMarkersTopic);
  PlayerConfig config;
  config.step_deadline_s = 0.1;
  config.resend_s = 0.02;
  RunningPlayback player({file}, {.step = true}, config);
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_THAT(player.Join(), HasSubstr("no answer on /forces to the frame with stamp 1970"));
}

TEST_F(RecordingNodeTest, StepsNeedATopicThatCanBeAnswered) {
  const auto file = WriteStates(folder_);
  EXPECT_THROW(RunningPlayback({file}, {.step = true}), InputError);
  EXPECT_THROW(RunningPlayback({file}, {.step = true, .step_topic = "/test/state"}), InputError);
  EXPECT_THROW(RunningPlayback({file}, {.step_topic = "/test/stade"}), InputError);
  EXPECT_THROW(RunningPlayback({file}, {.start_s = 5.0}), InputError);
}

TEST_F(RecordingNodeTest, ARecordingOfRos2HumbleIsPlayedAsItIs) {
  const auto file = test_support::MeasuredDataFolder() / "ros2/ros2_humble_image_wrench.mcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (set PALPATE_DATA_DIR)";
  auto depth = listener_.participant.CreateReader(dds::kDepthImageTopic);
  std::set<std::int64_t> stamps_ns;
  listener_.loop.Attach(depth, [&] {
    for (const auto& image : depth.Take()) stamps_ns.insert(dds::StampNs(image.header.stamp));
  });
  RunningPlayback player({file}, {.rate = 4.0});
  ASSERT_TRUE(WaitForEnd(player));
  EXPECT_EQ(player.Join(), "");
  EXPECT_TRUE(listener_.WaitFor([&] { return stamps_ns.size() == 60; }));
}

TEST_F(RecordingNodeTest, WhatIsRecordedOfAPlaybackIsTheRecordingToTheBit) {
  const auto first = RecordMarkers(folder_, 200);
  recorder::RecordPlan plan = recorder::RunningRecorder::PlanFor(folder_ / "again.mcap");
  plan.choice = {{"/perception/markers"}, {}};
  recorder::RunningRecorder recorder({}, plan);
  {
    RunningPlayback player({first}, {.rate = 2.0});
    ASSERT_TRUE(WaitForEnd(player));
    EXPECT_EQ(player.Join(), "");
  }
  EXPECT_EQ(recorder.Stop(), "");
  const auto bytes = [](const std::filesystem::path& file) {
    RecordingSource source({file}, {{"/perception/markers"}, {}});
    std::vector<std::string> all;
    while (const PlayedMessage* message = source.Next()) all.emplace_back(message->data);
    return all;
  };
  EXPECT_EQ(bytes(folder_ / "again.mcap"), bytes(first));
  EXPECT_EQ(bytes(first).size(), 200u);
}

}  // namespace
}  // namespace palpate::player
