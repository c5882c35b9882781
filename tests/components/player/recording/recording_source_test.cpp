// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/recording_source.hpp"

#include <gmock/gmock.h>

#include "libs/core/error.hpp"
#include "tests/components/player/recording/sample_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::player {
namespace {

using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> AllOf(RecordingSource& source) {
  std::vector<std::string> texts;
  while (const PlayedMessage* message = source.Next()) texts.push_back(TextOfCdr(message->data));
  return texts;
}

/// Two files, as the recorder splits them: the second begins with what is latched.
std::vector<std::filesystem::path> SplitRecording(const TestFolder& folder) {
  {
    SampleFile first(folder / "run_0000.mcap");
    const auto mesh = first.Channel("/mesh", kLatchedQos);
    const auto state = first.Channel("/state", kVolatileQos);
    first.Write(mesh, 0.0, "mesh1");
    first.Write(state, 1.0, "a");
    first.Write(state, 2.0, "b");
  }
  SampleFile second(folder / "run_0001.mcap");
  const auto mesh = second.Channel("/mesh", kLatchedQos);
  const auto state = second.Channel("/state", kVolatileQos);
  second.Write(mesh, 3.0, "mesh1");
  second.Write(state, 3.0, "c");
  second.Write(mesh, 3.5, "mesh2");
  second.Write(state, 4.0, "d");
  return {folder / "run_0001.mcap", folder / "run_0000.mcap"};
}

TEST(RecordingSource, PlaysSplitFilesInOrderWithoutWhatTheSplitRepeats) {
  const TestFolder folder;
  RecordingSource source(SplitRecording(folder), {});
  EXPECT_EQ(source.start_ns(), kSampleStart_ns);
  EXPECT_EQ(source.end_ns(), kSampleStart_ns + 4 * kSecond_ns);
  EXPECT_THAT(AllOf(source), ElementsAre("mesh1", "a", "b", "c", "mesh2", "d"));
  source.Seek(kSampleStart_ns + 2 * kSecond_ns);
  EXPECT_THAT(AllOf(source), ElementsAre("b", "mesh1", "c", "mesh2", "d"));
  source.Seek(kSampleStart_ns);
  EXPECT_EQ(AllOf(source).size(), 6u);
}

TEST(RecordingSource, KnowsWhatALateJoinerWouldHaveGot) {
  const TestFolder folder;
  const RecordingSource source(SplitRecording(folder), {});
  EXPECT_TRUE(source.LatchedBefore(kSampleStart_ns).empty());
  const auto early = source.LatchedBefore(kSampleStart_ns + kSecond_ns);
  ASSERT_EQ(early.size(), 1u);
  EXPECT_EQ(source.topics()[early[0].topic].name, "/mesh");
  EXPECT_EQ(TextOfCdr(early[0].data), "mesh1");
  const auto late = source.LatchedBefore(kSampleStart_ns + 4 * kSecond_ns);
  EXPECT_EQ(TextOfCdr(late.back().data), "mesh2");
}

TEST(RecordingSource, OfAKeyedTypeALateJoinerGetsAllInstances) {
  const TestFolder folder;
  const auto file = folder / "run.mcap";
  {
    SampleFile sample(file);
    recording::Channel channel;
    channel.schema_id = sample.writer().AddSchema(
        "lab::Gripper", "omgidl",
        "module lab {\n@final\nstruct Gripper {\n  @key\n  long id;\n};\n};\n");
    channel.topic = "gripper";
    channel.message_encoding = "cdr";
    channel.metadata = {{"offered_qos_profiles", kLatchedQos}};
    const auto id = sample.writer().AddChannel(channel);
    sample.Write(id, 0.0, "left");
    sample.Write(id, 1.0, "right");
    sample.Write(id, 3.0, "later");
  }
  const RecordingSource source({file}, {});
  EXPECT_TRUE(source.topics()[0].has_key);
  std::vector<std::string> texts;
  for (const auto& latched : source.LatchedBefore(kSampleStart_ns + 2 * kSecond_ns)) {
    texts.push_back(TextOfCdr(latched.data));
  }
  EXPECT_THAT(texts, ElementsAre("left", "right"));
}

TEST(RecordingSource, OtherEncodingsAreNamedAndTheRestIsPlayed) {
  const TestFolder folder;
  const auto file = folder / "run.mcap";
  {
    SampleFile sample(file);
    for (const char* encoding : {"ros1", "json", "protobuf"}) {
      sample.Write(sample.Channel("/" + std::string(encoding), "", encoding), 0.0, encoding);
    }
    sample.Write(sample.Channel("rt/state", ""), 1.0, "a");
    sample.Write(sample.Channel("ros_discovery_info", ""), 1.0, "graph");
  }
  RecordingSource source({file}, {});
  EXPECT_THAT(source.problems(),
              testing::UnorderedElementsAre(HasSubstr("channel /ros1 is not played: its messages "
                                                      "are 'ros1', only cdr"),
                                            HasSubstr("channel /json"), HasSubstr("/protobuf")));
  ASSERT_EQ(source.topics().size(), 1u);
  EXPECT_EQ(source.topics()[0].name, "/state");
  EXPECT_FALSE(source.topics()[0].qos);
  EXPECT_THAT(AllOf(source), ElementsAre("a"));
}

TEST(RecordingSource, RefusesWhatHasNothingToPlay) {
  const TestFolder folder;
  const auto files = SplitRecording(folder);
  try {
    RecordingSource source(files, {{"/nothing"}, {}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing to play"));
  }
}

TEST(OfferedQos, IsReadAsHumbleAndAsIronWriteIt) {
  EXPECT_EQ(ParseOfferedQos(kLatchedQos), (OfferedQos{true, true, 1}));
  EXPECT_EQ(ParseOfferedQos("- history: keep_last\n  depth: 7\n  reliability: best_effort\n"
                            "  durability: volatile\n"),
            (OfferedQos{false, false, 7}));
  EXPECT_EQ(ParseOfferedQos("- history: keep_all\n  depth: 0\n  reliability: reliable\n"),
            (OfferedQos{true, false, 0}));
  EXPECT_EQ(ParseOfferedQos(""), std::nullopt);
}

TEST(OfferedQos, OfManyWritersTheStrongestServesAllReaders) {
  EXPECT_EQ(ParseOfferedQos("- reliability: 2\n  durability: 1\n  depth: 1\n"
                            "- reliability: 1\n  durability: 2\n  depth: 5\n"),
            (OfferedQos{true, true, 5}));
}

}  // namespace
}  // namespace palpate::player
