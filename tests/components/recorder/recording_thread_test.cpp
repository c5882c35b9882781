// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recording_thread.hpp"

#include <gmock/gmock.h>

#include <future>

#include "libs/core/error.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recorder {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

TEST(RecordingThread, WritesAllThatWasPushedFromManyThreads) {
  const TestFolder folder;
  RecordingThread thread({}, folder / "run.mcap", {}, {});
  std::vector<std::future<void>> pushers;
  for (int p = 0; p < 4; ++p) {
    pushers.push_back(std::async(std::launch::async, [&, p] {
      const auto topic = SampleTopic("/t" + std::to_string(p));
      for (int i = 0; i < 500; ++i) ASSERT_TRUE(thread.Push(SampleMessage(topic, 0.01 * i)));
    }));
  }
  for (auto& pusher : pushers) pusher.get();
  thread.Stop();
  EXPECT_EQ(TopicsIn(folder / "run.mcap").size(), 2000u);
  EXPECT_EQ(thread.state().waiting_bytes, 0u);
  EXPECT_EQ(thread.state().written_bytes > 0, true);
}

TEST(RecordingThread, MoreThanMayWaitIsDroppedAndTheRestWritten) {
  const TestFolder folder;
  Config config;
  config.waiting_MB = 1.0;
  std::size_t taken = 0;
  {
    RecordingThread thread(config, folder / "run.mcap", {}, {});
    const auto topic = SampleTopic("/a");
    for (int i = 0; i < 3000; ++i) {
      taken += thread.Push(SampleMessage(topic, 0.001 * i, 30'000)) ? 1 : 0;
    }
    thread.Stop();
  }
  EXPECT_GT(taken, 30u);
  EXPECT_EQ(TopicsIn(folder / "run.mcap").size(), taken);
}

TEST(RecordingThread, ASnapshotHasWhatWasPushedBeforeAndItsReason) {
  const TestFolder folder;
  std::promise<void> saved;
  RecordingThread thread({}, std::nullopt, {}, [&] { saved.set_value(); });
  const auto topic = SampleTopic("/a");
  for (int i = 0; i < 50; ++i) thread.Push(SampleMessage(topic, 0.1 * i));
  thread.SaveRecent(folder / "snap.mcap", "camera: lost");
  saved.get_future().wait();
  EXPECT_THAT(thread.state().snapshots, testing::ElementsAre(folder / "snap.mcap"));
  EXPECT_EQ(TopicsIn(folder / "snap.mcap").size(), 50u);
  EXPECT_EQ(ReadFile(folder / "snap.txt"), "camera: lost\n");
  const recording::Reader reader(folder / "snap.mcap");
  ASSERT_EQ(reader.contents().metadata.size(), 1u);
  EXPECT_EQ(reader.Read(reader.contents().metadata[0]).values.at("reason"), "camera: lost");
  thread.Stop();
  EXPECT_TRUE(thread.state().files.empty());
}

TEST(RecordingThread, AFileThatExistsIsNotReplaced) {
  const TestFolder folder;
  folder.Write("run.mcap", "precious");
  EXPECT_THAT(MessageOf<RunError>([&] { RecordingThread({}, folder / "run.mcap", {}, {}); }),
              HasSubstr("run.mcap: cannot be written: File exists"));
}

TEST(RecordingThread, AnErrorIsToldAtOnceAndNothingMoreIsTaken) {
  const TestFolder folder;
  Config config;
  config.split_s = 1.0;
  folder.Write("run_0001.mcap", "in the way of the second file");
  std::promise<void> told;
  RecordingThread thread(config, folder / "run.mcap", {}, [&] { told.set_value(); });
  const auto topic = SampleTopic("/a");
  for (int i = 0; i < 10; ++i) thread.Push(SampleMessage(topic, 0.1 * i));
  thread.Push(SampleMessage(topic, 5.0));
  told.get_future().wait();
  EXPECT_THAT(thread.state().error, HasSubstr("run_0001.mcap: cannot be written"));
  EXPECT_FALSE(thread.Push(SampleMessage(topic, 6.0)));
  EXPECT_THAT(MessageOf<RunError>([&] { thread.Stop(); }), HasSubstr("run_0001.mcap"));
  EXPECT_EQ(TopicsIn(folder / "run_0000.mcap").size(), 10u);
}

}  // namespace
}  // namespace palpate::recorder
