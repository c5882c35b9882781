// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tests/components/player/recording/sample_recording.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"

/// The player under the load of a camera, in real time.
namespace palpate::player {
namespace {

using dds::TestNode;
using test_support::TestFolder;

/// Depth and colour of 848 x 480 and four small messages at 30 Hz.
void WriteCameraRecording(const std::filesystem::path& file, int frames) {
  recording::Writer writer(std::make_unique<recording::OutputFile>(file), {});
  const auto channel = [&](const std::string& topic, const std::string& type) {
    recording::Channel made;
    made.schema_id = writer.AddSchema(type, "ros2msg", "");
    made.topic = topic;
    made.message_encoding = "cdr";
    made.metadata = {{"offered_qos_profiles", kVolatileQos}};
    return writer.AddChannel(made);
  };
  const auto depth = channel("/camera/depth/image_raw", "sensor_msgs/msg/Image");
  const auto color = channel("/camera/color/image_raw", "sensor_msgs/msg/Image");
  const auto small = channel("/test/state", "std_msgs/msg/String");
  // An image of one row: its header, sizes, encoding and data, as CDR lays them out.
  const auto image = [](std::uint32_t size) {
    std::string cdr("\0\1\0\0", 4);
    const auto number = [&](std::uint32_t value) {
      for (int i = 0; i < 4; ++i) cdr += static_cast<char>(value >> (8 * i));
    };
    number(0);  // stamp
    number(0);
    number(1);  // frame_id
    cdr += std::string(4, '\0');
    number(1);     // height
    number(size);  // width
    number(6);     // encoding
    cdr += std::string("mono8\0", 6);
    cdr += '\0';  // is_bigendian
    cdr += '\0';
    number(size);  // step
    number(size);
    return cdr + std::string(size, 'x');
  };
  const std::string depth_cdr = image(848 * 480 * 2);
  const std::string color_cdr = image(848 * 480 * 3);
  const std::string text = CdrText("state");
  for (int i = 0; i < frames; ++i) {
    const std::int64_t time_ns = kSampleStart_ns + i * kSecond_ns / 30;
    writer.Write(recording::Message{depth, 0, time_ns, time_ns, depth_cdr});
    writer.Write(recording::Message{color, 0, time_ns + 2'000'000, time_ns, color_cdr});
    for (int k = 0; k < 4; ++k) {
      const std::int64_t then_ns = time_ns + (5 + 7 * k) * 1'000'000;
      writer.Write(recording::Message{small, 0, then_ns, then_ns, text});
    }
  }
  writer.Close();
}

/// Settings for one host, as its user has them.
class PlaybackLoad : public testing::Test {
 protected:
  PlaybackLoad() {
    setenv("CYCLONEDDS_URI", "file://" PALPATE_SOURCE_DIR "/config/cyclonedds/one_host.xml", 1);
  }
};

/// The lateness in ms depends on the machine: it is printed, and the README states it.
TEST_F(PlaybackLoad, EveryFrameComesAndNinetyNineOfAHundredBeforeTheNextFrameIsDue) {
  constexpr int kFrames = 60 * 30;
  const TestFolder folder;
  WriteCameraRecording(folder / "run.mcap", kFrames);
  TestNode listener("listener");
  listener.loop.Every(std::chrono::milliseconds(5), [] {});
  int depth_count = 0;
  int color_count = 0;
  auto depth = listener.participant.CreateReader(dds::kDepthImageTopic);
  auto color = listener.participant.CreateReader(dds::kColorImageTopic);
  listener.loop.Attach(depth, [&] {
    for (const auto& image : depth.Take()) depth_count += image.data._length > 0 ? 1 : 0;
  });
  listener.loop.Attach(color, [&] {
    for (const auto& image : color.Take()) color_count += image.data._length > 0 ? 1 : 0;
  });
  system_test::Process player("palpate-player", {(folder / "run.mcap").string(), "--json"},
                              folder / "log.txt");
  std::optional<int> code;
  listener.loop.DispatchUntil([&] { return !!(code = player.Wait(std::chrono::seconds(0))); },
                              dds::WaitSet::Clock::now() + std::chrono::seconds(100));
  ASSERT_EQ(code, 0) << player.Output();
  const std::string output = player.Output();
  const auto last = nlohmann::json::parse(output.substr(
      output.rfind("{\"position_s\""), output.rfind('}') + 1 - output.rfind("{\"position_s\"")));
  EXPECT_TRUE(last.at("ended"));
  const double p99_s = last.at("lateness_p99_s").get<double>();
  fmt::print("lateness: median {:.2f} ms, 99 % {:.2f} ms\n",
             1e3 * last.at("lateness_p50_s").get<double>(), 1e3 * p99_s);
  EXPECT_EQ(last.at("messages"), 6 * kFrames);
  EXPECT_LT(p99_s, 1.0 / 30);
  EXPECT_EQ(depth_count, kFrames);
  EXPECT_EQ(color_count, kFrames);
}

}  // namespace
}  // namespace palpate::player
