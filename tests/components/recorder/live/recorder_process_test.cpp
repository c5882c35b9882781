// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <csignal>
#include <functional>
#include <random>
#include <set>
#include <thread>

#include "Gripper.h"
#include "idl/message_traits.hpp"
#include "libs/core/file.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/recording/repair.hpp"
#include "libs/recording/ros2msg/cdr_reader.hpp"
#include "tests/components/recorder/live/running_recorder.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"

namespace palpate::recorder {
namespace {

using dds::TestNode;
using system_test::Process;
using test_support::TestFolder;
using testing::HasSubstr;

/// The program, with the network between it and the writers of the test.
class RecorderProgram : public testing::Test {
 protected:
  RecorderProgram() : robot_("robot") {
    robot_.loop.Every(std::chrono::milliseconds(2), [] {});
  }

  Process Start(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--out", file_.string()});
    return Process("palpate-recorder", arguments, folder_ / "log.txt");
  }

  std::string Log() const { return ReadFile(folder_ / "log.txt"); }

  const TestFolder folder_;
  const std::filesystem::path file_ = folder_ / "run.mcap";
  TestNode robot_;
};

TEST_F(RecorderProgram, RecordsEveryImageThatComesOverTheNetworkToTheBit) {
  auto depth = robot_.participant.CreateWriter(dds::kDepthImageTopic);
  Process recorder = Start({"--robot", "beam"});
  ASSERT_TRUE(robot_.WaitFor([&] { return depth.matched() > 0; })) << Log();
  dds::Message<idl::sensor_msgs::Image> image;
  dds::Resize(image->data, 814'080);
  std::mt19937 random(5);
  std::vector<std::string> sent;
  for (int i = 0; i < 40; ++i) {
    for (std::uint32_t k = 0; k < image->data._length; k += 100) {
      image->data._buffer[k] = static_cast<std::uint8_t>(random());
    }
    sent.emplace_back(reinterpret_cast<const char*>(image->data._buffer), image->data._length);
    ASSERT_TRUE(depth.Write(image));
    ASSERT_TRUE(depth.WaitUntilReceived(std::chrono::seconds(5)));
  }
  recorder.Signal(SIGINT);
  ASSERT_EQ(recorder.Wait(std::chrono::seconds(20)), 0) << Log();
  const recording::Reader reader(file_);
  EXPECT_TRUE(reader.contents().indexed);
  recording::MessageStream stream = reader.Messages();
  std::size_t count = 0;
  while (const recording::Message* message = stream.Next()) {
    ASSERT_LT(count, sent.size());
    EXPECT_EQ(message->data.substr(message->data.size() - sent[count].size()), sent[count]);
    ++count;
  }
  EXPECT_EQ(count, sent.size());
  std::set<std::string> attached;
  for (const auto& index : reader.contents().attachments) attached.insert(index.name);
  EXPECT_THAT(attached, testing::IsSupersetOf(
                            {"beam.yaml", "beam.msh", "recorder_settings.yaml", "topics.yaml"}));
}

TEST_F(RecorderProgram, ATypeOfNobodysPackageIsRecordedWithItsIdl) {
  PlainWriter writer(robot_, lab_Gripper_desc, "gripper", {});
  Process recorder = Start({});
  ASSERT_TRUE(robot_.WaitFor([&] { return writer.is_read(); })) << Log();
  lab_Gripper gripper{};
  gripper.id = 7;
  gripper.width_m = 0.25;
  ASSERT_TRUE(writer.Write(&gripper));
  ASSERT_TRUE(writer.WaitUntilReceived());
  recorder.Signal(SIGINT);
  ASSERT_EQ(recorder.Wait(std::chrono::seconds(20)), 0) << Log();
  const recording::Reader reader(file_);
  ASSERT_EQ(reader.contents().channels.size(), 1u);
  const recording::Channel& channel = reader.contents().channels.begin()->second;
  EXPECT_EQ(channel.topic, "gripper");
  EXPECT_EQ(reader.SchemaOf(channel).name, "lab::Gripper");
  EXPECT_EQ(reader.SchemaOf(channel).encoding, "omgidl");
  EXPECT_EQ(reader.SchemaOf(channel).data,
            "module lab {\nenum Mode {\n  @value(0) OPEN,\n  @value(1) CLOSED\n};\n};\n"
            "module lab {\ntypedef double Width;\n};\n"
            "module lab {\n@final\nstruct Finger {\n  string name;\n  float angles_rad[2][3];\n"
            "};\n};\n"
            "module lab {\n@final\nstruct Gripper {\n  @key\n  long id;\n  lab::Mode mode;\n"
            "  lab::Width width_m;\n  sequence<lab::Finger> fingers;\n  sequence<octet, 8> raw;\n"
            "};\n};\n");
  recording::MessageStream stream = reader.Messages();
  const recording::Message* message = stream.Next();
  ASSERT_NE(message, nullptr);
  recording::CdrReader cdr(message->data);
  EXPECT_EQ(cdr.Bits(4), 7u);
}

TEST_F(RecorderProgram, ASignalSavesASnapshotAndTheRecordingGoesOn) {
  auto markers = robot_.participant.CreateWriter(dds::kMarkersTopic);
  Process recorder = Start({});
  ASSERT_TRUE(robot_.WaitFor([&] { return markers.matched() > 0; })) << Log();
  ASSERT_TRUE(markers.Write(dds::Message<idl::palpate_msgs::MarkerArray3>()));
  ASSERT_TRUE(markers.WaitUntilReceived(std::chrono::seconds(5)));
  recorder.Signal(SIGUSR1);
  const auto saved = [&] { return Log().find("saved ") != std::string::npos; };
  ASSERT_TRUE(robot_.WaitFor(saved)) << Log();
  ASSERT_TRUE(markers.Write(dds::Message<idl::palpate_msgs::MarkerArray3>()));
  ASSERT_TRUE(markers.WaitUntilReceived(std::chrono::seconds(5)));
  recorder.Signal(SIGTERM);
  ASSERT_EQ(recorder.Wait(std::chrono::seconds(20)), 0) << Log();
  EXPECT_EQ(TopicsIn(file_).size(), 2u);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    if (!entry.path().filename().string().starts_with("run_snapshot_")) continue;
    EXPECT_EQ(TopicsIn(entry.path()).size(), 1u);
    return;
  }
  FAIL() << "no snapshot";
}

TEST_F(RecorderProgram, BadArgumentsAreRefusedBeforeItJoinsTheDomain) {
  const auto refusal = [&](const std::vector<std::string>& arguments) {
    const std::optional<int> code =
        system_test::RunProgram("palpate-recorder", arguments, folder_ / "refusal.txt");
    EXPECT_EQ(code, 2);
    return ReadFile(folder_ / "refusal.txt");
  };
  EXPECT_THAT(refusal({"--out", "a.bag"}), HasSubstr("--out: must end in .mcap, not 'a.bag'"));
  EXPECT_THAT(refusal({"--only-recent", "--set", "recent_s=0"}),
              HasSubstr("--only-recent needs recent_s above 0"));
  EXPECT_THAT(refusal({"--calibration", "none.yaml", "--out", file_.string()}),
              HasSubstr("none.yaml: cannot be read"));
  EXPECT_THAT(refusal({"--set", "compression=gzip"}), HasSubstr("zstd"));
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(RecorderProgram, AFileThatExistsIsNotReplaced) {
  folder_.Write("run.mcap", "precious");
  Process recorder = Start({});
  EXPECT_EQ(recorder.Wait(std::chrono::seconds(20)), 1);
  EXPECT_THAT(Log(), HasSubstr("run.mcap: cannot be written: File exists"));
  EXPECT_EQ(ReadFile(file_), "precious");
}

/// Kills the recorder `count` times at random moments while messages come.
class KilledRecorder : public RecorderProgram {
 protected:
  void KillOften(int count) {
    auto markers = robot_.participant.CreateWriter(dds::kMarkersTopic);
    std::mt19937 random(17);
    for (int i = 0; i < count; ++i) {
      const auto file = folder_ / ("run" + std::to_string(i) + ".mcap");
      const std::uint32_t seen = markers.counters().matched_ever;
      {
        Process recorder(
            "palpate-recorder",
            {"--out", file.string(), "--set", "flush_s=0.005", "--set", "chunk_MB=0.02", "--set",
             std::string("compression=") + (i % 2 == 0 ? "zstd" : "none")},
            folder_ / "log.txt");
        ASSERT_TRUE(robot_.WaitFor([&] { return markers.counters().matched_ever > seen; }))
            << Log();
        const std::uintmax_t size_at_the_end = 40'000 + random() % 100'000;
        std::uint64_t counter = 0;
        const auto grown = [&] {
          for (int k = 0; k < 10; ++k) {
            dds::Message<idl::palpate_msgs::MarkerArray3> message;
            message->counter = counter++;
            dds::Resize(message->markers, 1 + random() % 3);
            EXPECT_TRUE(markers.Write(message));
          }
          return std::filesystem::file_size(file) >= size_at_the_end;
        };
        ASSERT_TRUE(robot_.WaitFor(grown)) << Log();
        recorder.Signal(SIGKILL);
        ASSERT_EQ(recorder.Wait(std::chrono::seconds(20)), -SIGKILL);
      }
      EXPECT_GT(Check(file), 0u);
    }
  }

  /// Every whole chunk is readable, and a repair restores index and statistics.
  std::uint64_t Check(const std::filesystem::path& file) {
    const recording::InputFile input(file);
    const recording::Contents contents = recording::Scan(input);
    for (const std::string& problem : contents.problems) {
      EXPECT_THAT(problem, testing::AnyOf(HasSubstr("no whole record"), HasSubstr("cut off")));
    }
    std::filesystem::path repaired = file;
    repaired.replace_extension(".repaired.mcap");
    const recording::RepairResult result = recording::Repair(file, repaired);
    EXPECT_EQ(result.messages, contents.statistics.message_count);
    const recording::Reader reader(repaired);
    EXPECT_TRUE(reader.contents().indexed);
    EXPECT_EQ(reader.contents().statistics.message_count, result.messages);
    EXPECT_EQ(TopicsIn(repaired), TopicsIn(file));
    return result.messages;
  }
};

TEST_F(KilledRecorder, LeavesEveryWholeChunkReadable) { KillOften(5); }

using KilledRecorderOften = KilledRecorder;
TEST_F(KilledRecorderOften, LeavesEveryWholeChunkReadable) { KillOften(100); }

}  // namespace
}  // namespace palpate::recorder
