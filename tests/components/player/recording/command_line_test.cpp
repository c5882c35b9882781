// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/command_line.hpp"

#include <gmock/gmock.h>

#include "libs/core/error.hpp"
#include "tests/components/player/recording/sample_recording.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::player {
namespace {

using testing::HasSubstr;

class PlayCommand : public testing::Test {
 protected:
  PlayCommand() {
    SampleFile sample(folder_ / "run.mcap");
    sample.Write(sample.Channel("/test/state", kVolatileQos), 0.0, "a");
    std::filesystem::create_directory(folder_ / "experiment");
    std::filesystem::create_directory(folder_ / "split");
    for (const char* name : {"run_0000.mcap", "run_0001.mcap"}) {
      SampleFile part(folder_ / "split" / name);
      part.Write(part.Channel("/test/state", kVolatileQos), 0.0, "a");
    }
  }

  std::optional<Command> Read(std::vector<std::string> words) const {
    words.insert(words.begin(), "palpate-player");
    std::vector<const char*> arguments;
    for (const std::string& word : words) arguments.push_back(word.c_str());
    return ReadCommand(static_cast<int>(arguments.size()), arguments.data());
  }
  std::string Refusal(const std::vector<std::string>& words) const {
    try {
      Read(words);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string Mcap() const { return (folder_ / "run.mcap").string(); }
  std::string Experiment() const { return (folder_ / "experiment").string(); }

  const test_support::TestFolder folder_;
};

TEST_F(PlayCommand, TakesAFileAFolderOfFilesOrAnExperiment) {
  EXPECT_EQ(Read({Mcap()})->message_files.size(), 1u);
  EXPECT_EQ(Read({"--data", Mcap()})->message_files.size(), 1u);
  EXPECT_EQ(Read({(folder_ / "split").string()})->message_files.size(), 2u);
  EXPECT_TRUE(Read({Experiment(), "--images"})->message_files.empty());
}

TEST_F(PlayCommand, RefusesWhatDoesNotFitTogether) {
  EXPECT_THAT(Refusal({}), HasSubstr("RECORDING is required"));
  EXPECT_THAT(Refusal({Mcap(), "--data", Mcap()}), HasSubstr("give one"));
  EXPECT_THAT(Refusal({Mcap(), "--rate", "0"}), HasSubstr("must be above 0, not 0"));
  EXPECT_THAT(Refusal({Mcap(), "--rate", "2", "--step"}), HasSubstr("only one of --rate"));
  EXPECT_THAT(Refusal({Mcap(), "--images"}), HasSubstr("--images is for experiment folders"));
  EXPECT_THAT(Refusal({Experiment(), "--pause"}), HasSubstr("--pause is for MCAP and .db3 files"));
  EXPECT_THAT(Refusal({Mcap(), "--start", "-1"}), HasSubstr("--start: must be 0 or above"));
  EXPECT_THAT(Refusal({Mcap(), "--start", "3", "--end", "2"}), HasSubstr("behind --start"));
  EXPECT_THAT(Refusal({Mcap(), "--duration", "3", "--end", "2"}), HasSubstr("only one of --end"));
}

TEST_F(PlayCommand, ItsClockTakesThePlaceOfTheRecordedOne) {
  const auto command = Read({Mcap(), "--clock"});
  EXPECT_TRUE(command->config.publish_clock);
  EXPECT_THAT(command->excluded, testing::ElementsAre("/clock"));
}

}  // namespace
}  // namespace palpate::player
