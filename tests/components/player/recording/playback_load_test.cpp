// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "libs/app/process_tuning.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/statistics.hpp"
#include "tests/components/player/recording/sample_recording.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"

/// The player under the load of a camera, in real time.
namespace palpate::player {
namespace {

using dds::TestNode;
using test_support::TestFolder;

constexpr std::size_t kDepthBytes = 848 * 480 * 2;
constexpr std::size_t kColorBytes = 848 * 480 * 3;
/// After a frame's time: depth, colour, and four small messages.
constexpr std::array<std::chrono::milliseconds, 6> kOffsets{
    std::chrono::milliseconds(0),  std::chrono::milliseconds(2),  std::chrono::milliseconds(5),
    std::chrono::milliseconds(12), std::chrono::milliseconds(19), std::chrono::milliseconds(26)};

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
  const std::string depth_cdr = image(kDepthBytes);
  const std::string color_cdr = image(kColorBytes);
  const std::string text = CdrText("state");
  for (int i = 0; i < frames; ++i) {
    const std::int64_t time_ns = kSampleStart_ns + i * kSecond_ns / 30;
    for (std::size_t k = 0; k < kOffsets.size(); ++k) {
      const std::int64_t then_ns = time_ns + std::chrono::nanoseconds(kOffsets[k]).count();
      const auto channel_id = k == 0 ? depth : k == 1 ? color : small;
      const std::string& cdr = k == 0 ? depth_cdr : k == 1 ? color_cdr : text;
      writer.Write(recording::Message{channel_id, 0, then_ns, then_ns, cdr});
    }
  }
  writer.Close();
}

/// The least that a player does: sleeps until a message is due, and copies it to a buffer. Runs
/// until it goes out of scope. Its lateness is what the system adds, on this machine beside
/// whatever else runs there.
class BareLoop {
 public:
  BareLoop() : thread_([this] { Run(); }) {}
  ~BareLoop() { Stop(); }

  /// How late it woke up, s, of 99 %.
  double Stop() {
    stopped_ = true;
    if (thread_.joinable()) thread_.join();
    return Quantile(lateness_s_, 0.99);
  }

 private:
  void Run() {
    app::PreferPromptWakeUps();
    const std::string depth(kDepthBytes, 'x');
    const std::string color(kColorBytes, 'x');
    std::string sent;
    auto frame = std::chrono::steady_clock::now();
    while (!stopped_) {
      for (std::size_t k = 0; k < kOffsets.size(); ++k) {
        const auto due = frame + kOffsets[k];
        std::this_thread::sleep_until(due);
        lateness_s_.push_back(SecondsSince(due));
        if (k == 0) sent = depth;
        if (k == 1) sent = color;
      }
      frame += std::chrono::nanoseconds(kSecond_ns / 30);
    }
  }

  std::atomic<bool> stopped_ = false;
  std::vector<double> lateness_s_;
  std::thread thread_;
};

/// Settings for one host, as its user has them.
class PlaybackLoad : public testing::Test {
 protected:
  PlaybackLoad() {
    setenv("CYCLONEDDS_URI", "file://" PALPATE_SOURCE_DIR "/config/cyclonedds/one_host.xml", 1);
  }
};

TEST_F(PlaybackLoad, EveryFrameComesAndNinetyNineOfAHundredWithinTwoMillisecondsOfABareLoop) {
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
  BareLoop bare;
  std::optional<int> code;
  listener.loop.DispatchUntil([&] { return !!(code = player.Wait(std::chrono::seconds(0))); },
                              dds::WaitSet::Clock::now() + std::chrono::seconds(100));
  ASSERT_EQ(code, 0) << player.Output();
  const std::string output = player.Output();
  const auto last = nlohmann::json::parse(output.substr(
      output.rfind("{\"position_s\""), output.rfind('}') + 1 - output.rfind("{\"position_s\"")));
  EXPECT_TRUE(last.at("ended"));
  const double p99_s = last.at("lateness_p99_s").get<double>();
  const double bare_p99_s = bare.Stop();
  fmt::print("lateness: median {:.2f} ms, 99 % {:.2f} ms; 99 % of a bare loop {:.2f} ms\n",
             1e3 * last.at("lateness_p50_s").get<double>(), 1e3 * p99_s, 1e3 * bare_p99_s);
  EXPECT_EQ(last.at("messages"), 6 * kFrames);
  EXPECT_LT(p99_s, 2e-3 + bare_p99_s);
  EXPECT_EQ(depth_count, kFrames);
  EXPECT_EQ(color_count, kFrames);
}

}  // namespace
}  // namespace palpate::player
