// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>

#include "libs/recording/bytes.hpp"
#include "libs/recording/repair.hpp"
#include "tests/libs/recording/sample_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A chunk of a sample recording: where it ends, and how many messages there are up to it.
struct ChunkEnd {
  std::uint64_t offset;
  std::size_t messages;
};

std::vector<ChunkEnd> ChunkEnds(const std::filesystem::path& file) {
  const Reader reader(file);
  std::vector<ChunkEnd> ends;
  for (const Block& block : reader.contents().blocks) {
    MessageFilter filter;
    filter.end_time_ns = block.end_time_ns;
    ends.push_back(
        {block.offset + block.length, SamplesIn(reader.Messages(filter), reader).size()});
  }
  return ends;
}

std::size_t MessagesUpTo(std::uint64_t size, const std::vector<ChunkEnd>& ends) {
  std::size_t count = 0;
  for (const ChunkEnd& end : ends) count = end.offset <= size ? end.messages : count;
  return count;
}

class Damage : public testing::TestWithParam<Compression> {
 protected:
  void Write(int count) {
    samples_ = Samples(count);
    WriteSamples(whole_, samples_, SmallChunks(GetParam()));
    bytes_ = ReadFile(whole_);
  }

  const TestFolder folder_;
  const std::filesystem::path whole_ = folder_ / "whole.mcap";
  const std::filesystem::path damaged_ = folder_ / "damaged.mcap";
  std::vector<Sample> samples_;
  std::string bytes_;
};

TEST_P(Damage, CutAtAnyByteAllWholeChunksAreRead) {
  Write(60);
  const std::vector<ChunkEnd> ends = ChunkEnds(whole_);
  ASSERT_GT(ends.size(), 2u);
  for (std::size_t size = bytes_.size() - 1; size >= kMagic.size(); --size) {
    std::filesystem::resize_file(whole_, size);
    const std::size_t count = MessagesUpTo(size, ends);
    const std::vector<Sample> expected(samples_.begin(),
                                       samples_.begin() + static_cast<std::ptrdiff_t>(count));
    ASSERT_EQ(SamplesIn(whole_), expected) << "cut at byte " << size;
  }
}

TEST_P(Damage, RepairRestoresIndexAndStatisticsOfWhatIsWhole) {
  Write(60);
  const std::vector<ChunkEnd> ends = ChunkEnds(whole_);
  for (std::size_t i = 0; i < 20; ++i) {
    const std::size_t size = bytes_.size() * (i + 1) / 21;
    WriteFile(damaged_, bytes_.substr(0, size));
    const auto repaired = folder_ / ("repaired" + std::to_string(i) + ".mcap");
    const RepairResult result = Repair(damaged_, repaired);
    EXPECT_EQ(result.messages, MessagesUpTo(size, ends));
    EXPECT_THAT(result.problems, Contains(HasSubstr("cut off")));
    const Reader reader(repaired);
    EXPECT_TRUE(reader.contents().indexed);
    EXPECT_EQ(reader.contents().statistics.message_count, result.messages);
    EXPECT_EQ(SamplesIn(repaired), SamplesIn(damaged_));
    EXPECT_THAT(Scan(InputFile(repaired)).problems, IsEmpty());
  }
}

TEST_P(Damage, AFlippedByteInAChunkIsFoundAndCostsThatChunkOnly) {
  Write(60);
  const Reader reader(whole_);
  const std::vector<Block>& blocks = reader.contents().blocks;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    std::string bytes = bytes_;
    bytes[blocks[i].offset + blocks[i].length - 40] ^= 1;
    WriteFile(damaged_, bytes);
    const Reader damaged(damaged_);
    MessageStream stream = damaged.Messages();
    std::size_t count = 0;
    while (stream.Next() != nullptr) ++count;
    const std::string place = "byte " + std::to_string(blocks[i].offset) + ": chunk: ";
    EXPECT_THAT(stream.problems(), ElementsAre(HasSubstr(place)));
    EXPECT_LT(count, samples_.size());
    EXPECT_THAT(Scan(InputFile(damaged_)).problems, ElementsAre(HasSubstr(place)));
    const auto repaired = folder_ / ("repaired" + std::to_string(i) + ".mcap");
    EXPECT_EQ(Repair(damaged_, repaired).messages, count);
    EXPECT_EQ(SamplesIn(repaired).size(), count);
  }
}

INSTANTIATE_TEST_SUITE_P(Recording, Damage,
                         testing::Values(Compression::kNone, Compression::kZstd,
                                         Compression::kLz4));

TEST(DamagedFile, AFlippedByteAnywhereNeitherCrashesNorInventsMessages) {
  const TestFolder folder;
  const std::vector<Sample> samples = Samples(40);
  WriteSamples(folder / "whole.mcap", samples, SmallChunks(Compression::kZstd));
  const std::string bytes = ReadFile(folder / "whole.mcap");
  std::mt19937 random(11);
  for (int i = 0; i < 400; ++i) {
    std::string flipped = bytes;
    const std::size_t at = kMagic.size() + random() % (bytes.size() - kMagic.size());
    flipped[at] ^= static_cast<char>(1 << random() % 8);
    WriteFile(folder / "flipped.mcap", flipped);
    const Reader reader(folder / "flipped.mcap");
    MessageStream stream = reader.Messages();
    std::size_t count = 0;
    while (const Message* message = stream.Next()) {
      const auto is_it = [&](const Sample& sample) { return sample.data == message->data; };
      ASSERT_TRUE(std::any_of(samples.begin(), samples.end(), is_it)) << "byte " << at;
      ++count;
    }
    ASSERT_LE(count, samples.size());
  }
}

TEST(DamagedFile, ADamagedAttachmentIsRefusedAndARepairLeavesItOut) {
  const TestFolder folder;
  {
    Writer writer(std::make_unique<OutputFile>(folder / "r.mcap"), SmallChunks());
    writer.Write(Attachment{0, 0, "robot.yaml", "", std::string(500, 'r')});
    writer.Write(Attachment{0, 0, "mesh.vtu", "", std::string(500, 'm')});
    writer.Close();
  }
  std::string bytes = ReadFile(folder / "r.mcap");
  bytes[bytes.find("rrrr") + 20] = 'x';
  WriteFile(folder / "damaged.mcap", bytes);
  const Reader reader(folder / "damaged.mcap");
  EXPECT_THAT(MessageOf([&] { reader.Read(reader.contents().attachments[0]); }),
              HasSubstr("'robot.yaml' at byte"));
  EXPECT_EQ(reader.Read(reader.contents().attachments[1]).data, std::string(500, 'm'));
  const RepairResult result = Repair(folder / "damaged.mcap", folder / "repaired.mcap");
  EXPECT_THAT(result.problems, ElementsAre(HasSubstr("attachment: its CRC differs")));
  EXPECT_EQ(Reader(folder / "repaired.mcap").contents().attachments.size(), 1u);
}

TEST(DamagedFile, MessagesOutsideChunksAreRead) {
  const TestFolder folder;
  std::string bytes(kMagic);
  Put(FileHeader{"ros2", "somebody else's"}, &bytes);
  Put(Schema{3, "test_msgs/msg/T", "ros2msg", ""}, &bytes);
  Put(Channel{9, 3, "/t", "cdr", {}}, &bytes);
  Put(Message{9, 0, 20, 20, "second"}, &bytes);
  Put(Message{9, 0, 10, 10, "first"}, &bytes);
  PutRecord(static_cast<Opcode>(0x7F), "of a later version", &bytes);
  Put(Message{9, 0, 30, 30, "third"}, &bytes);
  folder.Write("loose.mcap", bytes);
  const std::vector<Sample> samples = SamplesIn(folder / "loose.mcap");
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(samples[0].data, "first");
  EXPECT_EQ(samples[1].data, "second");
  EXPECT_EQ(samples[2].data, "third");
}

TEST(DamagedFile, AnUnknownCompressionIsNamed) {
  const TestFolder folder;
  std::string bytes(kMagic);
  Put(FileHeader{"", ""}, &bytes);
  PutChunkHead({0, 0, 10, 0, "bzip9", 4}, &bytes);
  bytes += "abcd";
  folder.Write("r.mcap", bytes);
  EXPECT_THAT(Reader(folder / "r.mcap").contents().problems,
              Contains(HasSubstr("compression 'bzip9' is not known")));
}

}  // namespace
}  // namespace palpate::recording
