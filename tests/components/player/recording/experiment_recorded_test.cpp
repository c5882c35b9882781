// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "components/player/node/node.hpp"
#include "tests/components/player/sample_experiment.hpp"
#include "tests/components/recorder/live/running_recorder.hpp"
#include "tests/components/recorder/sample_messages.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::player {
namespace {

TEST(ExperimentRecorded, ARecorderThatStartsWithThePlayerGetsEveryFrame) {
  const test_support::TestFolder folder;
  PlayerNode player({}, {.rate = std::numeric_limits<double>::infinity()},
                    ExperimentPlayer(SampleExperiment(), "", true),
                    static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {});
  recorder::RunningRecorder recorder(folder / "run.mcap");
  player.Run();
  EXPECT_EQ(recorder.Stop(), "");
  const std::vector<std::string> topics = recorder::TopicsIn(folder / "run.mcap");
  EXPECT_EQ(std::count(topics.begin(), topics.end(), "/perception/markers"), 8);
  EXPECT_GE(std::count(topics.begin(), topics.end(), "/robot/joint_states"), 8);
}

}  // namespace
}  // namespace palpate::player
