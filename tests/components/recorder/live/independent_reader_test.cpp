// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "libs/core/file.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/recorder/live/running_recorder.hpp"
#include "tests/support/test_folder.hpp"

/// What the recorder writes, read by @mcap/core and decoded by @foxglove/rosmsg2-serialization.
namespace palpate::recorder {
namespace {

using dds::TestNode;
using nlohmann::json;
using test_support::TestFolder;

const std::filesystem::path kScripts = PALPATE_SOURCE_DIR "/tests/components/recorder/independent";
const std::filesystem::path kInstalled = PALPATE_BINARY_DIR "/independent_mcap";

int Shell(const std::string& command) { return std::system(command.c_str()); }

class IndependentReader : public testing::TestWithParam<std::string> {
 protected:
  /// Installs the pinned packages once for each build folder.
  void SetUp() override {
    if (Shell("npm --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "npm is not installed";
    if (std::filesystem::exists(kInstalled / "node_modules/@mcap/core")) return;
    std::filesystem::create_directories(kInstalled);
    for (const char* name : {"package.json", "package-lock.json"}) {
      std::filesystem::copy_file(kScripts / name, kInstalled / name,
                                 std::filesystem::copy_options::overwrite_existing);
    }
    if (Shell("npm ci --ignore-scripts --no-audit --no-fund --prefix " + kInstalled.string() +
              " > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << "npm cannot install what " << kScripts << "/package-lock.json names";
    }
  }

  /// One value for each message, and one for the totals.
  std::vector<json> Read(const std::filesystem::path& file) const {
    const std::filesystem::path lines = folder_ / "lines.json";
    const int code = Shell("node " + (kScripts / "read_mcap.mjs").string() + " " + file.string() +
                           " " + (kInstalled / "node_modules").string() + " > " + lines.string() +
                           " 2> " + (folder_ / "error.txt").string());
    EXPECT_EQ(code, 0) << ReadFile(folder_ / "error.txt");
    std::vector<json> values;
    std::istringstream text(ReadFile(lines));
    for (std::string line; std::getline(text, line);) values.push_back(json::parse(line));
    return values;
  }

  const TestFolder folder_;
};

dds::Message<idl::palpate_msgs::MarkerArray3> SampleMarkers(int i) {
  dds::Message<idl::palpate_msgs::MarkerArray3> message;
  dds::SetHeader(message->header, 1'500'000'000 + i, "robot");
  message->counter = static_cast<std::uint64_t>(i);
  dds::SetText(message->recording, "ramp");
  dds::Resize(message->markers, 2);
  dds::SetText(message->markers._buffer[0].name, "m1");
  message->markers._buffer[0].position_m = {0.25, -0.5, 1e-3 * i};
  message->markers._buffer[0].valid = true;
  dds::SetText(message->markers._buffer[1].name, "a longer name");
  return message;
}

dds::Message<idl::sensor_msgs::JointState> SampleJoints() {
  dds::Message<idl::sensor_msgs::JointState> message;
  dds::SetHeader(message->header, 7, "robot");
  dds::Resize(message->name, 2);
  dds::SetText(message->name._buffer[0], "north");
  dds::SetText(message->name._buffer[1], "south");
  const std::array<double, 2> values{0.125, std::numeric_limits<double>::quiet_NaN()};
  dds::SetNumbers(message->position, values.data(), values.size());
  return message;
}

void ExpectMarkers(const json& line, int i) {
  const json expected = {
      {"header", {{"stamp", {{"sec", 1}, {"nanosec", 500'000'000 + i}}}, {"frame_id", "robot"}}},
      {"counter", std::to_string(i)},
      {"recording", "ramp"},
      {"reference_shape", 0}};
  for (const auto& [key, value] : expected.items()) EXPECT_EQ(line["message"][key], value) << key;
  const json& markers = line["message"]["markers"];
  ASSERT_EQ(markers.size(), 2u);
  EXPECT_EQ(markers[0]["name"], "m1");
  EXPECT_EQ(markers[0]["valid"], true);
  EXPECT_EQ(markers[0]["position_m"], (json{{"x", 0.25}, {"y", -0.5}, {"z", 1e-3 * i}}));
  EXPECT_EQ(markers[1]["name"], "a longer name");
  EXPECT_EQ(markers[1]["covariance_m2"], json(std::vector<double>(9, 0.0)));
}

TEST_P(IndependentReader, FindsEveryCrcRightAndDecodesEveryField) {
  TestNode robot("robot");
  robot.loop.Every(std::chrono::milliseconds(5), [] {});
  auto markers = robot.participant.CreateWriter(dds::kMarkersTopic);
  auto joints = robot.participant.CreateWriter(dds::kJointStatesTopic);
  auto depth = robot.participant.CreateWriter(dds::kDepthImageTopic);
  NodeConfig config;
  config.compression = GetParam();
  config.chunk_MB = 0.01;
  RecordPlan plan = RunningRecorder::PlanFor(folder_ / "run.mcap");
  plan.extras.options = WriterOptionsOf(config, "test");
  plan.extras.attachments.push_back({0, 0, "robot.yaml", "", "name: a\n"});
  RunningRecorder recorder(config, plan);
  ASSERT_TRUE(robot.WaitFor(
      [&] { return markers.matched() > 0 && joints.matched() > 0 && depth.matched() > 0; }));
  constexpr int kCount = 100;
  for (int i = 0; i < kCount; ++i) ASSERT_TRUE(markers.Write(SampleMarkers(i)));
  ASSERT_TRUE(joints.Write(SampleJoints()));
  dds::Message<idl::sensor_msgs::Image> image;
  dds::SetText(image->encoding, "16UC1");
  dds::Resize(image->data, 100'000);
  image->data._buffer[99'999] = 200;
  ASSERT_TRUE(depth.Write(image));
  ASSERT_EQ(recorder.Stop(), "");

  const std::vector<json> lines = Read(folder_ / "run.mcap");
  ASSERT_EQ(lines.size(), kCount + 3u);
  for (int i = 0; i < kCount; ++i) ExpectMarkers(lines[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(lines[kCount]["message"]["name"], (json::array({"north", "south"})));
  EXPECT_EQ(lines[kCount]["message"]["position"], (json::array({0.125, "NaN"})));
  EXPECT_EQ(lines[kCount]["message"]["velocity"], json::array());
  const json& pixels = lines[kCount + 1]["message"]["data"];
  ASSERT_EQ(pixels.size(), 100'000u);
  EXPECT_EQ(pixels[99'999], 200);
  EXPECT_EQ(lines.back(),
            (json{{"messages", kCount + 2}, {"attachments", json::array({"robot.yaml"})}}));
}

INSTANTIATE_TEST_SUITE_P(Compressions, IndependentReader, testing::Values("none", "zstd", "lz4"));

}  // namespace
}  // namespace palpate::recorder
