// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recording_file.hpp"

#include <gmock/gmock.h>

#include "libs/core/error.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recorder {
namespace {

using test_support::TestFolder;
using testing::ElementsAre;

FileExtras SampleExtras() {
  FileExtras extras;
  extras.attachments.push_back({0, 0, "robot.yaml", "", "name: a"});
  extras.metadata.push_back({"palpate", {{"version", "1"}}});
  return extras;
}

TEST(RecordingFiles, WithoutSplittingThereIsOneFileOfTheGivenName) {
  const TestFolder folder;
  RecordingFiles files(folder / "run.mcap", SampleExtras(), {});
  for (int i = 0; i < 100; ++i) files.Write(SampleMessage(SampleTopic("/a"), 100.0 * i));
  files.Close();
  EXPECT_THAT(files.files(), ElementsAre(folder / "run.mcap"));
  EXPECT_EQ(TopicsIn(folder / "run.mcap").size(), 100u);
  EXPECT_EQ(files.size(), std::filesystem::file_size(folder / "run.mcap"));
}

TEST(RecordingFiles, SplitByTimeEachFileHasItsSecondsAndNoMessageIsLost) {
  const TestFolder folder;
  RecordingFiles files(folder / "run.mcap", SampleExtras(), {.bytes = 0, .duration_s = 1.0});
  const auto topic = SampleTopic("/a");
  for (int i = 0; i < 35; ++i) files.Write(SampleMessage(topic, 0.1 * i));
  files.Close();
  EXPECT_THAT(files.files(), ElementsAre(folder / "run_0000.mcap", folder / "run_0001.mcap",
                                         folder / "run_0002.mcap", folder / "run_0003.mcap"));
  std::size_t count = 0;
  for (const auto& file : files.files()) count += TopicsIn(file).size();
  EXPECT_EQ(count, 35u);
  EXPECT_EQ(TopicsIn(files.files()[0]).size(), 10u);
}

TEST(RecordingFiles, SplitBySizeNoFileHasMoreMessagesThanFit) {
  const TestFolder folder;
  RecordingFiles files(folder / "run.mcap", {}, {.bytes = 5000, .duration_s = 0.0});
  const auto topic = SampleTopic("/a");
  for (int i = 0; i < 100; ++i) files.Write(SampleMessage(topic, i));
  files.Close();
  EXPECT_GT(files.files().size(), 2u);
  std::size_t count = 0;
  for (const auto& file : files.files()) {
    EXPECT_LE(TopicsIn(file).size() * 100, 5000u);
    count += TopicsIn(file).size();
  }
  EXPECT_EQ(count, 100u);
}

TEST(RecordingFiles, EachFileCanStandAlone) {
  const TestFolder folder;
  RecordingFiles files(folder / "run.mcap", SampleExtras(), {.bytes = 0, .duration_s = 1.0});
  const auto topic = SampleTopic("/a");
  files.Write(SampleMessage(SampleTopic("/robot/mesh", true), 0.0));
  for (int i = 0; i < 25; ++i) files.Write(SampleMessage(topic, 0.1 * i));
  files.Close();
  ASSERT_EQ(files.files().size(), 3u);
  for (const auto& file : files.files()) {
    EXPECT_EQ(TopicsIn(file).front(), "/robot/mesh");
    const recording::Reader reader(file);
    EXPECT_EQ(reader.contents().attachments.size(), 1u);
    EXPECT_EQ(reader.contents().metadata.size(), 1u);
  }
}

TEST(RecordingFiles, ATopicWhoseQosChangesHasAChannelForEach) {
  const TestFolder folder;
  RecordingFiles files(folder / "run.mcap", {}, {});
  TopicDescription reliable = *SampleTopic("/a");
  reliable.qos = "- reliability: 1";
  files.Write(SampleMessage(std::make_shared<TopicDescription>(reliable), 0.0));
  reliable.qos = "- reliability: 2";
  files.Write(SampleMessage(std::make_shared<TopicDescription>(reliable), 1.0));
  files.Close();
  const recording::Reader reader(folder / "run.mcap");
  EXPECT_EQ(reader.contents().channels.size(), 2u);
  EXPECT_EQ(reader.contents().schemas.size(), 1u);
}

}  // namespace
}  // namespace palpate::recorder
