// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

#include "libs/recording/reader.hpp"
#include "libs/recording/ros2msg/flatten.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

/// A run is recorded, and its inputs are played again to a new estimator.
namespace palpate::system_test::recorded_forces {
namespace {

using std::chrono::seconds;

constexpr const char* kType = "palpate_msgs/msg/ForceArray";

/// The message with zeros for the times that it took to estimate it.
std::string WithoutDurations(std::string_view cdr) {
  const recording::Definitions& definitions = recording::BuiltInDefinitions();
  recording::CdrReader reader = recording::AtField(cdr, kType, "age_s", definitions);
  const std::uint64_t age = reader.Bits(8);
  const std::uint64_t latency = reader.Bits(8);
  EXPECT_TRUE(reader.ok());
  std::string both(16, '\0');
  std::memcpy(both.data(), &age, 8);
  std::memcpy(both.data() + 8, &latency, 8);
  std::string bytes(cdr);
  const std::size_t at = bytes.find(both);
  EXPECT_NE(at, bytes.npos);
  return at == bytes.npos ? bytes : bytes.replace(at, 16, 16, '\0');
}

/// By recording and stamp.
using Forces = std::map<std::pair<std::string, std::int64_t>, std::string>;

Forces ForcesIn(const std::filesystem::path& file) {
  const recording::Reader reader(file);
  recording::MessageFilter filter;
  filter.wanted = [](const recording::Channel& channel) { return channel.topic == "/forces"; };
  recording::MessageStream stream = reader.Messages(filter);
  Forces forces;
  while (const recording::Message* message = stream.Next()) {
    recording::CdrReader header(message->data);
    const auto second = static_cast<std::int64_t>(header.Bits(4));
    const auto stamp_ns = second * 1'000'000'000 + static_cast<std::int64_t>(header.Bits(4));
    recording::CdrReader name =
        recording::AtField(message->data, kType, "recording", recording::BuiltInDefinitions());
    forces[{std::string(name.String()), stamp_ns}] = WithoutDurations(message->data);
  }
  return forces;
}

/// Records /forces, and whatever else `topics` names, of an estimator that `player` is played to.
Forces Record(const Sample& sample, const TestFolder& folder, const std::string& name,
              const std::vector<std::string>& player_arguments) {
  const auto file = folder / (name + ".mcap");
  dds::TestNode observer("observer");
  observer.loop.Every(std::chrono::milliseconds(5), [] {});
  auto forces = observer.participant.CreateReader(dds::kForcesTopic);
  auto statuses = observer.participant.CreateReader(dds::kComponentStatusTopic);
  Process estimator("palpate-force-estimation",
                    {sample.robot.string(), "--contact", sample.contact}, folder / "fe.log");
  const auto within = [] { return dds::WaitSet::Clock::now() + seconds(60); };
  EXPECT_TRUE(observer.loop.DispatchUntil([&] { return forces.matched() == 1; }, within()));
  Process recorder("palpate-recorder", {"--out", file.string()}, folder / (name + "_rec.log"));
  EXPECT_TRUE(observer.loop.DispatchUntil([&] { return statuses.matched() == 2; }, within()));
  Process player("palpate-player", player_arguments, folder / (name + "_player.log"));
  EXPECT_EQ(player.Wait(seconds(90)), 0) << player.Output();
  recorder.Signal(SIGINT);
  EXPECT_EQ(recorder.Wait(seconds(20)), 0) << recorder.Output();
  estimator.Signal(SIGTERM);
  EXPECT_EQ(estimator.Wait(seconds(20)), 0) << estimator.Output();
  return ForcesIn(file);
}

void ExpectTheSameForces(const Sample& sample, const TestFolder& folder, std::size_t least) {
  const Forces live = Record(sample, folder, "live", {"--data", sample.data.string(), "--step"});
  const Forces again = Record(sample, folder, "again", {(folder / "live.mcap").string(), "--step"});
  EXPECT_GE(live.size(), least);
  ASSERT_EQ(again.size(), live.size());
  for (const auto& [frame, bytes] : live) {
    const auto found = again.find(frame);
    ASSERT_NE(found, again.end()) << frame.second;
    EXPECT_EQ(found->second, bytes) << frame.first << " at " << frame.second << " ns";
  }
}

TEST(RecordedForces, AreThoseOfTheLiveRunToTheBitOnTheBeam) {
  const TestFolder folder;
  ExpectTheSameForces(WriteBeamSample(folder, 10), folder, 15);
}

TEST(RecordedForces, AreThoseOfTheLiveRunToTheBitOnTheRobotWithCables) {
  const TestFolder folder;
  ExpectTheSameForces(WriteFourLegSample(folder), folder, 3);
}

}  // namespace
}  // namespace palpate::system_test::recorded_forces
