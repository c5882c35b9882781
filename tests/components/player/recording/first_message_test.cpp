// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "libs/dds/stamp.hpp"
#include "tests/components/player/recording/running_playback.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"

/// The player as a process of its own, which finds its readers before they have found it. It begins
/// as soon as it knows one (settle_s=0), again and again.
namespace palpate::player {
namespace {

using dds::TestNode;
using test_support::TestFolder;

constexpr int kStarts = 10;

class FirstMessage : public testing::Test {
 protected:
  std::string Domain() const { return std::to_string(dds::TestDomain()); }

  /// Dispatches in `node` until the player ends.
  void Play(TestNode& node, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--domain", Domain(), "--set", "settle_s=0"});
    system_test::Process player("palpate-player", arguments, folder_ / "log.txt");
    node.loop.Every(std::chrono::milliseconds(5), [] {});
    std::optional<int> code;
    node.WaitFor([&] { return !!(code = player.Wait(std::chrono::seconds(0))); });
    EXPECT_EQ(code, 0) << player.Output();
  }

  const TestFolder folder_;
};

/// Thirty states, 1 ms apart: many more than a writer keeps come before a late discovery.
TEST_F(FirstMessage, OfAMessageFileIsReceivedByWhoWaited) {
  const auto file = folder_ / "states.mcap";
  std::vector<std::string> expected;
  {
    SampleFile sample(file);
    const auto state = sample.Channel("/test/state", kVolatileQos);
    for (int i = 0; i < 30; ++i) {
      expected.push_back(std::to_string(i));
      sample.Write(state, 0.001 * i, expected.back());
    }
  }
  for (int i = 0; i < kStarts; ++i) {
    TestNode listener("listener");
    TextListener states(listener, "/test/state");
    Play(listener, {file.string()});
    EXPECT_EQ(states.texts(), expected) << "start " << i;
  }
}

TEST_F(FirstMessage, OfAnExperimentIsReceivedByWhoWaited) {
  folder_.Write("experiment.yaml", "robot: none.yaml\nframe: robot\n");
  folder_.Write("recordings/a/recording.yaml", "kind: free\n");
  std::string rows = "t_s,marker,x_m,y_m,z_m\n";
  for (int i = 0; i < 200; ++i) rows += std::to_string(0.001 * i) + ",tip,0,0,0.1\n";
  folder_.Write("recordings/a/markers.csv", rows);
  for (int i = 0; i < kStarts; ++i) {
    TestNode listener("listener");
    auto markers = listener.participant.CreateReader(dds::kMarkersTopic);
    std::vector<std::uint64_t> counters;
    listener.loop.Attach(markers, [&] {
      for (const auto& message : markers.Take()) counters.push_back(message.counter);
    });
    Play(listener, {"--data", (folder_ / ".").string()});
    ASSERT_FALSE(counters.empty());
    EXPECT_EQ(counters.front(), 0u) << "start " << i;
    EXPECT_EQ(counters.size(), 200u) << "start " << i;
  }
}

}  // namespace
}  // namespace palpate::player
