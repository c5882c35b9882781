// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/libs/recording/sample_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

class RoundTrip : public testing::TestWithParam<Compression> {};

TEST_P(RoundTrip, GivesEveryMessageBackToTheBit) {
  const TestFolder folder;
  const std::vector<Sample> samples = Samples(200);
  WriteSamples(folder / "r.mcap", samples, SmallChunks(GetParam()));
  const Reader reader(folder / "r.mcap");
  EXPECT_TRUE(reader.contents().indexed);
  EXPECT_EQ(reader.contents().header.profile, "ros2");
  EXPECT_GT(reader.contents().blocks.size(), 10u);
  EXPECT_EQ(SamplesIn(reader.Messages(), reader), samples);
}

TEST_P(RoundTrip, TheWholeFileSaysWhatItsIndexSays) {
  const TestFolder folder;
  WriteSamples(folder / "r.mcap", Samples(200), SmallChunks(GetParam()));
  const InputFile file(folder / "r.mcap");
  const Contents scanned = Scan(file);
  const std::optional<Contents> indexed = ReadSummary(file);
  ASSERT_TRUE(indexed.has_value());
  EXPECT_THAT(scanned.problems, testing::IsEmpty());
  EXPECT_EQ(scanned.statistics.message_count, 200u);
  EXPECT_EQ(scanned.statistics.channel_message_counts, indexed->statistics.channel_message_counts);
  EXPECT_EQ(scanned.statistics.start_time_ns, indexed->statistics.start_time_ns);
  EXPECT_EQ(scanned.statistics.end_time_ns, indexed->statistics.end_time_ns);
  EXPECT_EQ(scanned.statistics.chunk_count, indexed->statistics.chunk_count);
  ASSERT_EQ(scanned.blocks.size(), indexed->blocks.size());
  for (std::size_t i = 0; i < scanned.blocks.size(); ++i) {
    EXPECT_EQ(scanned.blocks[i].offset, indexed->blocks[i].offset);
    EXPECT_EQ(scanned.blocks[i].length, indexed->blocks[i].length);
    EXPECT_EQ(scanned.blocks[i].channels, indexed->blocks[i].channels);
    EXPECT_EQ(scanned.blocks[i].start_time_ns, indexed->blocks[i].start_time_ns);
    EXPECT_EQ(scanned.blocks[i].end_time_ns, indexed->blocks[i].end_time_ns);
  }
}

INSTANTIATE_TEST_SUITE_P(Recording, RoundTrip,
                         testing::Values(Compression::kNone, Compression::kZstd,
                                         Compression::kLz4));

TEST(Recording, CompressionMakesItSmaller) {
  const TestFolder folder;
  const std::vector<Sample> samples = Samples(200);
  WriteSamples(folder / "none.mcap", samples, SmallChunks());
  const auto plain = std::filesystem::file_size(folder / "none.mcap");
  for (const Compression compression : {Compression::kZstd, Compression::kLz4}) {
    const auto file = folder / (std::string(McapName(compression)) + ".mcap");
    WriteSamples(file, samples, SmallChunks(compression));
    EXPECT_LT(std::filesystem::file_size(file), plain * 3 / 4);
  }
}

TEST(Recording, AttachmentsAndMetadataComeBack) {
  const TestFolder folder;
  {
    Writer writer(std::make_unique<OutputFile>(folder / "r.mcap"), SmallChunks());
    writer.Write(Attachment{5, 4, "robot.yaml", "application/yaml", std::string("na\0me", 5)});
    writer.Write(Metadata{"versions", {{"palpate", "0.1"}, {"empty", ""}}});
    WriteSample(Samples(1).front(), &writer);
    writer.Write(Attachment{9, 9, "mesh.vtu", "application/xml", std::string(100000, 'x')});
    writer.Close();
  }
  const Reader reader(folder / "r.mcap");
  ASSERT_EQ(reader.contents().attachments.size(), 2u);
  ASSERT_EQ(reader.contents().metadata.size(), 1u);
  const Attachment robot = reader.Read(reader.contents().attachments[0]);
  EXPECT_EQ(robot.name, "robot.yaml");
  EXPECT_EQ(robot.media_type, "application/yaml");
  EXPECT_EQ(robot.data, std::string("na\0me", 5));
  EXPECT_EQ(robot.log_time_ns, 5);
  EXPECT_EQ(robot.create_time_ns, 4);
  EXPECT_EQ(reader.Read(reader.contents().attachments[1]).data.size(), 100000u);
  const Metadata versions = reader.Read(reader.contents().metadata[0]);
  EXPECT_EQ(versions.values,
            (std::map<std::string, std::string>{{"palpate", "0.1"}, {"empty", ""}}));
}

TEST(Recording, MessagesComeInTheOrderOfTheirLogTimeThoughTheClockJumpsBack) {
  const TestFolder folder;
  std::vector<Sample> samples = Samples(100);
  for (std::size_t i = 60; i < samples.size(); ++i) samples[i].log_time_ns -= 450'000'000;
  WriteSamples(folder / "r.mcap", samples, SmallChunks());
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.log_time_ns < b.log_time_ns; });
  EXPECT_EQ(SamplesIn(folder / "r.mcap"), samples);
}

TEST(Recording, MessagesOfOneTimeComeInTheOrderOfTheFile) {
  const TestFolder folder;
  std::vector<Sample> samples = Samples(100);
  for (Sample& sample : samples) sample.log_time_ns = 5;
  WriteSamples(folder / "r.mcap", samples, SmallChunks());
  EXPECT_EQ(SamplesIn(folder / "r.mcap"), samples);
}

TEST(Recording, AStretchOfTimeAndAChoiceOfTopicsIsWhatWasAskedFor) {
  const TestFolder folder;
  const std::vector<Sample> samples = Samples(200);
  WriteSamples(folder / "r.mcap", samples, SmallChunks());
  const Reader reader(folder / "r.mcap");
  MessageFilter filter;
  filter.start_time_ns = samples[50].log_time_ns;
  filter.end_time_ns = samples[120].log_time_ns;
  filter.wanted = [](const Channel& channel) { return channel.topic == "/b/c"; };
  std::vector<Sample> expected;
  std::copy_if(samples.begin() + 50, samples.begin() + 121, std::back_inserter(expected),
               [](const Sample& sample) { return sample.topic == "/b/c"; });
  EXPECT_EQ(SamplesIn(reader.Messages(filter), reader), expected);
}

TEST(Recording, ALateReaderGetsTheNewestMessageOfEachLatchedTopic) {
  const TestFolder folder;
  const std::vector<Sample> samples = Samples(200);
  WriteSamples(folder / "r.mcap", samples, SmallChunks());
  const Reader reader(folder / "r.mcap");
  const auto latched = [](const Channel& channel) { return channel.topic != "/d"; };
  const auto newest = reader.NewestBefore(samples[100].log_time_ns, latched);
  ASSERT_EQ(newest.size(), 2u);
  // 99 is of /a, 100 of /b/c.
  EXPECT_EQ(newest[0].data, samples[99].data);
  EXPECT_EQ(newest[1].data, samples[100].data);
  EXPECT_THAT(reader.NewestBefore(samples[0].log_time_ns - 1, latched), testing::IsEmpty());
}

TEST(Recording, ATopicWhoseTypeChangesHasAChannelForEachType) {
  const TestFolder folder;
  {
    Writer writer(std::make_unique<OutputFile>(folder / "r.mcap"), SmallChunks());
    for (const std::string type : {"old_msgs/msg/T", "new_msgs/msg/T", "old_msgs/msg/T"}) {
      const std::uint16_t schema = writer.AddSchema(type, "ros2msg", "uint8 " + type.substr(0, 3));
      const std::uint16_t channel = writer.AddChannel(
          {.id = 0, .schema_id = schema, .topic = "/t", .message_encoding = "cdr", .metadata = {}});
      writer.Write(Message{channel, 0, 0, 0, type});
    }
    writer.Close();
  }
  const Reader reader(folder / "r.mcap");
  EXPECT_EQ(reader.contents().channels.size(), 2u);
  MessageStream stream = reader.Messages();
  int count = 0;
  while (const Message* message = stream.Next()) {
    const Channel& channel = reader.contents().channels.at(message->channel_id);
    EXPECT_EQ(channel.topic, "/t");
    EXPECT_EQ(reader.SchemaOf(channel).name, message->data);
    ++count;
  }
  EXPECT_EQ(count, 3);
}

TEST(Recording, AMessageOf30MBIsOneOfMany) {
  const TestFolder folder;
  std::vector<Sample> samples = Samples(30);
  std::mt19937 random(3);
  samples[15].data = RandomBytes(30'000'000, &random);
  WriteSamples(folder / "r.mcap", samples, SmallChunks(Compression::kLz4));
  EXPECT_EQ(SamplesIn(folder / "r.mcap"), samples);
}

TEST(Recording, LargeMessagesAmongSmallOnesComeBackAndHaveTheirIndex) {
  const TestFolder folder;
  std::vector<Sample> samples = Samples(60);
  std::mt19937 random(4);
  for (std::size_t i = 5; i < samples.size(); i += 7) {
    samples[i].data = RandomBytes(300'000, &random);
  }
  WriterOptions options;
  WriteSamples(folder / "r.mcap", samples, options);
  EXPECT_EQ(SamplesIn(folder / "r.mcap"), samples);
  const InputFile file(folder / "r.mcap");
  const Contents scanned = Scan(file);
  EXPECT_THAT(scanned.problems, testing::IsEmpty());
  EXPECT_EQ(scanned.statistics.channel_message_counts,
            ReadSummary(file)->statistics.channel_message_counts);
  EXPECT_EQ(scanned.blocks.size(), ReadSummary(file)->blocks.size());
}

TEST(Recording, SmallMessagesCostFewBytesMoreThanTheyHave) {
  const TestFolder folder;
  constexpr int kCount = 5000;
  std::vector<Sample> samples;
  for (int i = 0; i < kCount; ++i) {
    samples.push_back({"/small", i * std::int64_t{200'000}, 0, 0, std::string(20, 'x')});
  }
  WriterOptions options;
  options.library = "test";
  WriteSamples(folder / "r.mcap", samples, options);
  EXPECT_EQ(SamplesIn(folder / "r.mcap"), samples);
  // The format's own: 31 bytes of each message's head, 16 of its index.
  EXPECT_LT(std::filesystem::file_size(folder / "r.mcap"), kCount * (20 + 31 + 16) + 2000);
}

TEST(Recording, WithoutMessagesIsARecording) {
  const TestFolder folder;
  WriteSamples(folder / "r.mcap", {}, SmallChunks());
  const Reader reader(folder / "r.mcap");
  EXPECT_TRUE(reader.contents().indexed);
  EXPECT_EQ(reader.contents().statistics.message_count, 0u);
  EXPECT_EQ(reader.Messages().Next(), nullptr);
}

TEST(Recording, NeverReplacesAFile) {
  const TestFolder folder;
  folder.Write("r.mcap", "precious");
  const std::string message = MessageOf<RunError>([&] { OutputFile output(folder / "r.mcap"); });
  EXPECT_THAT(message, HasSubstr("r.mcap: cannot be written: File exists"));
  EXPECT_EQ(ReadFile(folder / "r.mcap"), "precious");
}

TEST(Recording, OtherFilesAreRefused) {
  const TestFolder folder;
  folder.Write("r.mcap", "t_s,x_m\n1,2\n");
  EXPECT_THAT(MessageOf([&] { Reader reader(folder / "r.mcap"); }),
              HasSubstr("r.mcap: is no MCAP recording"));
  EXPECT_THAT(MessageOf([&] { Reader reader(folder / "none.mcap"); }),
              HasSubstr("none.mcap: cannot be read: No such file"));
  EXPECT_THAT(MessageOf([&] { Reader reader(folder.path()); }),
              HasSubstr("cannot be read: Is a directory"));
}

}  // namespace
}  // namespace palpate::recording
