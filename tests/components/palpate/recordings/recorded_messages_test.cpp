// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/recorded_messages.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "components/palpate/recordings/describe_recording.hpp"
#include "tests/components/palpate/recordings/topic_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr char kType[] = "std_msgs/msg/String";

command::TopicRecording Words(std::int64_t first_ns) {
  command::TopicRecording messages;
  for (int i = 0; i < 4; ++i) {
    messages.Add(i % 2 == 0 ? "/a" : "/b", kType, first_ns + 100 * i,
                 command::Cdr().Text(std::to_string(first_ns + i)));
  }
  return messages;
}

std::vector<std::pair<std::string, std::int64_t>> AllOf(const RecordedMessages& recorded,
                                                        const MessageFilter& filter = {}) {
  std::vector<std::pair<std::string, std::int64_t>> all;
  RecordedStream stream = recorded.Messages(filter);
  while (const Message* message = stream.Next()) {
    all.emplace_back(recorded.contents().channels.at(message->channel_id).topic,
                     message->log_time_ns);
  }
  return all;
}

TEST(RecordedMessages, ASqliteRecordingReadsAsAnMcapFile) {
  const TestFolder folder;
  Words(1000).WriteMcap(folder / "run.mcap");
  Words(1000).WriteSqlite(folder / "run.db3");
  const RecordedMessages mcap({folder / "run.mcap"});
  const RecordedMessages sqlite({folder / "run.db3"});
  EXPECT_EQ(sqlite.storage_id(), "sqlite3");
  EXPECT_EQ(AllOf(sqlite), AllOf(mcap));
  EXPECT_EQ(AllOf(sqlite).size(), 4u);
  EXPECT_EQ(sqlite.contents().statistics.start_time_ns, 1000);
  EXPECT_EQ(sqlite.contents().statistics.end_time_ns, 1300);
  RecordedStream a = sqlite.Messages();
  RecordedStream b = mcap.Messages();
  while (const Message* message = a.Next()) EXPECT_EQ(message->data, b.Next()->data);
}

TEST(RecordedMessages, PartsAreReadByTime) {
  const TestFolder folder;
  Words(2000).WriteMcap(folder / "run_0.mcap");
  Words(1050).WriteMcap(folder / "run_1.mcap");
  const RecordedMessages recorded(MessageFilesOf(folder.path()));
  EXPECT_THAT(AllOf(recorded),
              ElementsAre(std::pair("/a", 1050), std::pair("/b", 1150), std::pair("/a", 1250),
                          std::pair("/b", 1350), std::pair("/a", 2000), std::pair("/b", 2100),
                          std::pair("/a", 2200), std::pair("/b", 2300)));
  EXPECT_EQ(recorded.contents().channels.size(), 2u);
  EXPECT_EQ(recorded.contents().statistics.message_count, 8u);
}

TEST(RecordedMessages, AFilterChoosesTopicsAndTimes) {
  const TestFolder folder;
  Words(1000).WriteSqlite(folder / "run.db3");
  MessageFilter filter;
  filter.wanted = [](const Channel& channel) { return channel.topic == "/b"; };
  filter.start_time_ns = 1200;
  EXPECT_THAT(AllOf(RecordedMessages({folder / "run.db3"}), filter),
              ElementsAre(std::pair("/b", 1300)));
}

TEST(RecordedMessages, KnowTheNewestMessageOfEachChannelBeforeATime) {
  const TestFolder folder;
  for (const char* format : {"mcap", "sqlite"}) {
    std::filesystem::create_directory(folder / format);
  }
  Words(2000).WriteMcap(folder / "mcap/run_0.mcap");
  Words(1050).WriteMcap(folder / "mcap/run_1.mcap");
  Words(2000).WriteSqlite(folder / "sqlite/run_0.db3");
  Words(1050).WriteSqlite(folder / "sqlite/run_1.db3");
  for (const char* format : {"mcap", "sqlite"}) {
    const RecordedMessages recorded(MessageFilesOf(folder / format));
    const auto newest = [&](std::int64_t time_ns) {
      std::vector<std::pair<std::string, std::int64_t>> found;
      const auto all = [](const Channel&) { return true; };
      for (const StoredMessage& stored : recorded.NewestBefore(time_ns, all)) {
        found.emplace_back(recorded.contents().channels.at(stored.message.channel_id).topic,
                           stored.message.log_time_ns);
        EXPECT_FALSE(stored.data.empty());
      }
      std::sort(found.begin(), found.end());
      return found;
    };
    EXPECT_THAT(newest(1049), IsEmpty()) << format;
    EXPECT_THAT(newest(1050), ElementsAre(std::pair("/a", 1050))) << format;
    EXPECT_THAT(newest(1999), ElementsAre(std::pair("/a", 1250), std::pair("/b", 1350))) << format;
    EXPECT_THAT(newest(2000), ElementsAre(std::pair("/a", 2000), std::pair("/b", 1350))) << format;
  }
}

TEST(RecordedMessages, ASqliteRecordingIsDescribed) {
  const TestFolder folder;
  Words(1000).WriteSqlite(folder / "run.db3");
  const auto described = command::DescribeRecording({folder / "run.db3"});
  EXPECT_THAT(described.text, HasSubstr("Storage id:        sqlite3\n"));
  EXPECT_THAT(described.text, HasSubstr("Topic: /a | Type: std_msgs/msg/String | Count: 2"));
}

TEST(RecordedMessages, OtherFilesAreRefusedWithTheReason) {
  const TestFolder folder;
  folder.Write("run.db3", std::string("SQLite format 3\0 and no more", 28));
  folder.Write("packed/run_0.db3.zstd", "zstd");
  folder.Write("notes.txt", "no messages");
  EXPECT_THAT(MessageOf([&] { RecordedMessages({folder / "run.db3"}); }),
              HasSubstr("is no recording of rosbag2 (storage sqlite3) that can be read"));
  EXPECT_THAT(MessageOf([&] { MessageFilesOf(folder / "packed"); }),
              HasSubstr("was compressed as a whole by rosbag2; unpack"));
  EXPECT_THAT(MessageFilesOf(folder / "notes.txt"), IsEmpty());
}

}  // namespace
}  // namespace palpate::recording
