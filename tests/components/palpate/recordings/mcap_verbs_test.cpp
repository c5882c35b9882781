// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "components/palpate/recordings/describe_recording.hpp"
#include "components/palpate/recordings/repair_verb.hpp"
#include "libs/core/file.hpp"
#include "libs/recording/recorded_messages.hpp"
#include "tests/libs/recording/sample_recording.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using recording::Samples;
using recording::SmallChunks;
using recording::WriteSamples;
using test_support::MessageOf;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(DescribeRecording, SaysWhatRos2BagInfoSays) {
  const TestFolder folder;
  WriteSamples(folder / "run.mcap", Samples(100), SmallChunks());
  const RecordingDescription described =
      DescribeRecording(recording::MessageFilesOf(folder / "run.mcap"));
  EXPECT_THAT(described.text, HasSubstr("Storage id:        mcap\n"
                                        "Duration:          0.990000000s\n"
                                        "Start:             1970-01-01T00:00:01.000Z"));
  EXPECT_THAT(described.text,
              HasSubstr("Messages:          100\n"
                        "Topic information: Topic: /a | Type: test_msgs/msg/T | Count: 34 | "
                        "Serialization Format: cdr\n"
                        "                   Topic: /b/c | Type: test_msgs/msg/T | Count: 33 |"));
  EXPECT_EQ(described.json["messages"], 100);
  EXPECT_EQ(described.json["topics"][0]["count"], 34);
  EXPECT_EQ(described.json["start_ns"], 1'000'000'000);
  EXPECT_THAT(described.json["problems"], IsEmpty());
}

TEST(DescribeRecording, FilesOfOneFolderAreOneRecording) {
  const TestFolder folder;
  WriteSamples(folder / "run_0000.mcap", Samples(100), SmallChunks());
  WriteSamples(folder / "run_0001.mcap", Samples(50), SmallChunks());
  folder.Write("metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_THAT(recording::MessageFilesOf(folder.path()),
              ElementsAre(folder / "run_0000.mcap", folder / "run_0001.mcap"));
  EXPECT_EQ(DescribeRecording(recording::MessageFilesOf(folder.path())).json["messages"], 150);
}

TEST(DescribeRecording, OtherTargetsAreNoRecordings) {
  const TestFolder folder;
  WriteSamples(folder / "run.mcap", Samples(10), SmallChunks());
  folder.Write("experiment.yaml", "robot: beam.yaml\n");
  EXPECT_THAT(recording::MessageFilesOf(folder.path()), IsEmpty());
  EXPECT_THAT(recording::MessageFilesOf(folder / "experiment.yaml"), IsEmpty());
  EXPECT_THAT(recording::MessageFilesOf("four_leg"), IsEmpty());
}

TEST(DescribeRecording, ACutFileIsDescribedWithTheRemedy) {
  const TestFolder folder;
  WriteSamples(folder / "run.mcap", Samples(100), SmallChunks());
  std::filesystem::resize_file(folder / "run.mcap", 8000);
  const RecordingDescription described = DescribeRecording({folder / "run.mcap"});
  EXPECT_THAT(described.text, HasSubstr("the recording was cut off"));
  EXPECT_THAT(described.text, HasSubstr("`palpate repair"));
  EXPECT_GT(described.json["messages"], 10);
}

TEST(DescribeRecording, ARecordingOfRos2IsDescribed) {
  const auto file = test_support::MeasuredDataFolder() / "ros2/ros2_humble_image_wrench.mcap";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << " (set PALPATE_DATA_DIR)";
  const RecordingDescription described = DescribeRecording({file});
  EXPECT_THAT(described.text, HasSubstr("rt/force"));
  EXPECT_THAT(described.json["problems"], IsEmpty());
}

TEST(RepairVerb, WritesANewFileAndSaysWhatIsLost) {
  const TestFolder folder;
  WriteSamples(folder / "run.mcap", Samples(100), SmallChunks());
  std::filesystem::resize_file(folder / "run.mcap", 8000);
  const std::string before = ReadFile(folder / "run.mcap");
  testing::internal::CaptureStdout();
  EXPECT_EQ(Repair({folder / "run.mcap", "", false}), 0);
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_THAT(said, HasSubstr("no whole record"));
  EXPECT_THAT(said, HasSubstr("run_repaired.mcap: "));
  EXPECT_TRUE(recording::Reader(folder / "run_repaired.mcap").contents().indexed);
  EXPECT_EQ(ReadFile(folder / "run.mcap"), before);
}

TEST(RepairVerb, RefusesWhatItCannotDo) {
  const TestFolder folder;
  WriteSamples(folder / "run.mcap", Samples(10), SmallChunks());
  folder.Write("there.mcap", "precious");
  const auto refusal = [&](const std::string& file, const std::filesystem::path& out) {
    return MessageOf([&] { Repair({folder / file, out, false}); });
  };
  EXPECT_THAT(refusal("run.mcap", folder / "there.mcap"), HasSubstr("there.mcap: exists"));
  EXPECT_THAT(refusal("run.mcap", folder / "none" / "a.mcap"), HasSubstr("none"));
  EXPECT_THAT(refusal("there.mcap", folder / "new.mcap"), HasSubstr("is no MCAP recording"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new.mcap"));
}

}  // namespace
}  // namespace palpate::command
