// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>

#include "libs/recording/repair.hpp"
#include "tests/libs/recording/sample_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

/// A disk with room for so many bytes. As a real one does, it takes what fits before it fails.
class SmallDisk : public Output {
 public:
  SmallDisk(std::uint64_t room, std::string* bytes) : room_(room), bytes_(*bytes) {}

  void Append(std::string_view bytes) override {
    const std::size_t fits = std::min<std::size_t>(bytes.size(), room_ - bytes_.size());
    bytes_.append(bytes.substr(0, fits));
    if (fits < bytes.size()) throw RunError("disk full");
  }
  void Truncate(std::uint64_t size) override { bytes_.resize(size); }
  void Close() override {}

 private:
  std::uint64_t room_;
  std::string& bytes_;
};

TEST(FullDisk, IsSaidAtOnceAndLeavesAFileOfWholeChunksWithAnIndex) {
  const TestFolder folder;
  const std::vector<Sample> samples = Samples(200);
  std::string whole;
  {
    Writer writer(std::make_unique<SmallDisk>(1'000'000, &whole), SmallChunks());
    for (const Sample& sample : samples) WriteSample(sample, &writer);
  }
  for (std::size_t room = 200; room < whole.size(); room += 333) {
    std::string bytes;
    bool told = false;
    std::size_t chunks_before = 0;
    {
      Writer writer(std::make_unique<SmallDisk>(room, &bytes), SmallChunks());
      try {
        for (const Sample& sample : samples) {
          chunks_before = writer.statistics().chunk_count;
          WriteSample(sample, &writer);
        }
        writer.Close();
      } catch (const RunError& error) {
        told = true;
        EXPECT_STREQ(error.what(), "disk full");
      }
    }
    ASSERT_TRUE(told) << room;
    folder.Write("full.mcap", bytes);
    const std::vector<Sample> read = SamplesIn(folder / "full.mcap");
    const std::vector<Sample> expected(samples.begin(),
                                       samples.begin() + static_cast<std::ptrdiff_t>(read.size()));
    ASSERT_EQ(read, expected) << room;
    EXPECT_GE(Scan(InputFile(folder / "full.mcap")).statistics.chunk_count, chunks_before);
  }
}

TEST(FullDisk, ThePlaceOfTheLastChunkHoldsTheIndex) {
  const TestFolder folder;
  std::string bytes;
  WriterOptions options;
  options.chunk_bytes = 8'000;
  Writer writer(std::make_unique<SmallDisk>(20'000, &bytes), options);
  int failures = 0;
  for (const Sample& sample : Samples(200)) {
    try {
      WriteSample(sample, &writer);
    } catch (const RunError&) {
      ++failures;
      break;
    }
  }
  EXPECT_EQ(failures, 1);
  writer.Close();
  folder.Write("full.mcap", bytes);
  const Reader reader(folder / "full.mcap");
  EXPECT_TRUE(reader.contents().indexed);
  EXPECT_EQ(reader.contents().statistics.message_count, SamplesIn(folder / "full.mcap").size());
  EXPECT_GT(reader.contents().statistics.message_count, 0u);
}

TEST(FullDisk, AFolderThatIsMissingIsNamed) {
  const TestFolder folder;
  const std::string message =
      MessageOf<RunError>([&] { OutputFile output(folder / "none" / "recording.mcap"); });
  EXPECT_THAT(message, HasSubstr("recording.mcap: cannot be written: No such file"));
}

}  // namespace
}  // namespace palpate::recording
