// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/read_ahead.hpp"

#include <gmock/gmock.h>

#include "tests/libs/recording/sample_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using test_support::TestFolder;

/// Time and bytes of every message, from a stream or from a reader ahead of it.
template <typename Source>
std::vector<std::pair<std::int64_t, std::string>> AllOf(Source& source) {
  std::vector<std::pair<std::int64_t, std::string>> all;
  while (const Message* message = source.Next()) {
    all.emplace_back(message->log_time_ns, std::string(message->data));
  }
  return all;
}

/// More than may wait in memory.
std::filesystem::path WriteLarge(const TestFolder& folder) {
  const auto file = folder / "large.mcap";
  Writer writer(std::make_unique<OutputFile>(file), {});
  Channel channel;
  channel.schema_id = writer.AddSchema("std_msgs/msg/String", "ros2msg", "");
  channel.topic = "/text";
  channel.message_encoding = "cdr";
  const auto id = writer.AddChannel(channel);
  const std::size_t size = ReadAhead::kBatchBytes / 4;
  for (std::size_t i = 0; i < 6 * ReadAhead::kBatches; ++i) {
    const std::string data(size + i, static_cast<char>('a' + i % 26));
    const auto time_ns = static_cast<std::int64_t>(i);
    writer.Write(Message{id, 0, time_ns, time_ns, data});
  }
  writer.Close();
  return file;
}

TEST(ReadAhead, GivesTheMessagesOfTheStream) {
  const TestFolder folder;
  const RecordedMessages recorded({WriteLarge(folder)});
  RecordedStream stream = recorded.Messages();
  const auto expected = AllOf(stream);
  ASSERT_EQ(expected.size(), 6 * ReadAhead::kBatches);
  ReadAhead ahead(recorded.Messages());
  EXPECT_EQ(AllOf(ahead), expected);
  EXPECT_EQ(ahead.Next(), nullptr);  // and stays at the end
}

TEST(ReadAhead, EndsWhileMessagesWait) {
  const TestFolder folder;
  const RecordedMessages recorded({WriteLarge(folder)});
  ReadAhead ahead(recorded.Messages());
  const Message* first = ahead.Next();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->data.front(), 'a');
}

TEST(ReadAhead, OfAnEmptyRangeThereIsNothing) {
  const TestFolder folder;
  const RecordedMessages recorded({WriteLarge(folder)});
  MessageFilter filter;
  filter.start_time_ns = 1'000'000;
  ReadAhead ahead(recorded.Messages(filter));
  EXPECT_EQ(ahead.Next(), nullptr);
}

}  // namespace
}  // namespace palpate::recording
