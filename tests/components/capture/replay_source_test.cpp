// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/replay/replay_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/capture/make_source.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/rgbd/png.hpp"
#include "tests/components/capture/simulated_camera.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::capture {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::HasSubstr;

constexpr std::int64_t kStep_ns = 40'000'000;

/// A recording of `count` frames from `first_ns` on; depth values hold their number.
void WriteRecording(const TestFolder& folder, const std::string& name, int count,
                    std::int64_t first_ns) {
  const rgbd::RgbdCamera camera = SmallCamera();
  folder.Write(name + "/recording.yaml", "kind: free\n");
  folder.Write(name + "/camera.yaml", rgbd::FormatCameraFile(camera));
  std::filesystem::create_directories(folder.path() / name / "depth");
  std::filesystem::create_directories(folder.path() / name / "color");
  for (int i = 0; i < count; ++i) {
    const auto frame = PatternFrame(camera, static_cast<std::uint16_t>(i + 1));
    const std::string file = std::to_string(first_ns + i * kStep_ns) + ".png";
    rgbd::WriteDepthPng(folder.path() / name / "depth" / file, frame.depth);
    rgbd::WriteColorPng(folder.path() / name / "color" / file, frame.color);
  }
}

ReplayConfig Of(const std::filesystem::path& folder, const std::string& clock) {
  ReplayConfig config;
  config.folder = folder;
  config.clock = clock;
  return config;
}

std::vector<FramePtr> PlayAll(FrameSource& source, std::size_t at_most = 1000) {
  std::vector<FramePtr> frames;
  while (frames.size() < at_most) {
    FramePtr frame = source.Next(20.0);
    if (!frame) break;
    frames.push_back(std::make_shared<SourceFrame>(*frame));
  }
  return frames;
}

TEST(ReplaySource, GivesEveryFrameOfARecordingWholeAndInOrder) {
  const TestFolder folder;
  WriteRecording(folder, "one", 12, 5'000'000'000);
  for (const char* clock : {"as_fast_as_possible", "step"}) {
    ReplayConfig config = Of(folder.path() / "one", clock);
    config.stamp_offset_s = 1000.5;
    ReplaySource source(config, 2, app::LoadYaml);
    const auto frames = PlayAll(source);
    ASSERT_EQ(frames.size(), 12u) << clock;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto wanted = PatternFrame(SmallCamera(), static_cast<std::uint16_t>(i + 1));
      EXPECT_EQ(frames[i]->images.depth, wanted.depth);
      EXPECT_EQ(frames[i]->images.color, wanted.color);
      EXPECT_EQ(frames[i]->facts.stamp_device_ns, 5'000'000'000 + static_cast<int>(i) * kStep_ns);
      EXPECT_EQ(frames[i]->facts.stamp_host_ns,
                frames[i]->facts.stamp_device_ns + 1'000'500'000'000);
      EXPECT_EQ(frames[i]->facts.clock_source, ClockSource::kReplay);
      EXPECT_EQ(frames[i]->facts.epoch, 1u);
      EXPECT_EQ(frames[i]->camera->depth, SmallCamera().depth);
    }
    EXPECT_EQ(source.Health().state, SourceState::kEnded);
    EXPECT_EQ(source.Health().frames, 12u);
    EXPECT_EQ(source.Health().frames_dropped, 0u);
  }
}

TEST(ReplaySource, ALoopGoesOnInTimeAndEpoch) {
  const TestFolder folder;
  WriteRecording(folder, "one", 3, 0);
  ReplayConfig config = Of(folder.path() / "one", "as_fast_as_possible");
  config.loop = true;
  ReplaySource source(config, 2, app::LoadYaml);
  const auto frames = PlayAll(source, 9);
  ASSERT_EQ(frames.size(), 9u);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i]->facts.stamp_host_ns - frames[i - 1]->facts.stamp_host_ns, kStep_ns) << i;
    EXPECT_EQ(frames[i]->facts.epoch, 1 + i / 3);
    EXPECT_EQ(frames[i]->images.depth.values[0], 1 + i % 3);
  }
}

TEST(ReplaySource, RealTimeIsPaced) {
  const TestFolder folder;
  WriteRecording(folder, "one", 6, 0);
  ReplayConfig config = Of(folder.path() / "one", "real_time");
  config.rate = 2.0;
  ReplaySource source(config, 8, app::LoadYaml);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(PlayAll(source).size(), 6u);
  EXPECT_GE(SecondsSince(start), 5 * 0.040 / 2.0);
}

TEST(ReplaySource, RealTimeDropsTheOldestForASlowReaderAndCounts) {
  const TestFolder folder;
  WriteRecording(folder, "one", 10, 0);
  ReplayConfig config = Of(folder.path() / "one", "real_time");
  config.rate = 1000.0;
  ReplaySource source(config, 2, app::LoadYaml);
  source.Next(20.0);
  const Deadline deadline = In(20.0);
  while (source.Health().frames_dropped < 7 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  const auto rest = PlayAll(source);
  ASSERT_EQ(rest.size(), 2u);
  EXPECT_EQ(rest[1]->images.depth.values[0], 10);
  EXPECT_EQ(source.Health().frames_dropped, 7u);
}

TEST(ReplaySource, AFrameThatCannotBeReadIsCountedAndNamedAndTheNextFollows) {
  const TestFolder folder;
  WriteRecording(folder, "one", 5, 0);
  folder.Write("one/depth/" + std::to_string(2 * kStep_ns) + ".png", "no picture");
  ReplaySource source(Of(folder.path() / "one", "as_fast_as_possible"), 2, app::LoadYaml);
  EXPECT_EQ(PlayAll(source).size(), 4u);
  EXPECT_EQ(source.Health().frames_failed, 1u);
  EXPECT_THAT(source.Health().last_failure, HasSubstr("80000000.png"));
}

TEST(ReplaySource, ATumFolderIsPlayed) {
  const TestFolder folder;
  rgbd::DepthImage depth(640, 480, 5000);
  depth.values[0] = 0;
  std::filesystem::create_directories(folder.path() / "depth");
  std::filesystem::create_directories(folder.path() / "rgb");
  rgbd::WriteDepthPng(folder.path() / "depth/1.000000.png", depth);
  rgbd::WriteColorPng(folder.path() / "rgb/1.004000.png", rgbd::ColorImage(640, 480, 9));
  folder.Write("depth.txt", "# depth maps\n1.000000 depth/1.000000.png\n");
  folder.Write("rgb.txt", "# color images\n1.004000 rgb/1.004000.png\n");
  ReplaySource source(Of(folder.path(), "as_fast_as_possible"), 2, app::LoadYaml);
  const auto frames = PlayAll(source);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0]->facts.stamp_host_ns, 1'000'000'000);
  EXPECT_DOUBLE_EQ(frames[0]->camera->depth_unit_m, 1.0 / 5000.0);
  EXPECT_EQ(frames[0]->images.color.values[0], 9);
  EXPECT_DOUBLE_EQ(frames[0]->facts.valid_ratio, (640.0 * 480.0 - 1.0) / (640.0 * 480.0));
}

TEST(ReplaySource, AFolderWithoutFramesIsRefusedAtTheStart) {
  const TestFolder folder;
  EXPECT_THAT(MessageOf([&] { ReplaySource(Of(folder.path(), "step"), 2, app::LoadYaml); }),
              HasSubstr(folder.path().filename().string()));
  EXPECT_THAT(MessageOf([&] { ReplaySource(Of("", "step"), 2, app::LoadYaml); }),
              HasSubstr("replay.folder"));
}

TEST(ReplaySource, EndsAtOnceInTheMiddleOfARecording) {
  const TestFolder folder;
  WriteRecording(folder, "one", 3, 0);
  for (const char* clock : {"real_time", "as_fast_as_possible", "step"}) {
    ReplayConfig config = Of(folder.path() / "one", clock);
    config.rate = 0.001;  // 40 s from frame to frame
    config.loop = true;
    ReplaySource source(config, 1, app::LoadYaml);
    EXPECT_NE(source.Next(20.0), nullptr);
  }
}

TEST(MakeSource, SettingsThatDoNotFitTogetherAreRefused) {
  const auto message = [](const Config& config) {
    return MessageOf([&] { MakeSource(config, app::LoadYaml); });
  };
  Config config;
  config.source = "fake";
  config.depth.distortion = {0.1, 0.2};
  EXPECT_THAT(message(config), HasSubstr("depth.distortion"));
  config.depth.distortion.clear();
  config.depth.intrinsics_px = {500.0, 500.0};
  EXPECT_THAT(message(config), HasSubstr("depth.intrinsics_px: 4 numbers"));
  config.depth.intrinsics_px = {500.0, 0.0, 1.0, 1.0};
  EXPECT_THAT(message(config), HasSubstr("focal lengths"));
  config.depth.intrinsics_px.clear();
  config.color_pose = {0.1, 0.0, 0.0};
  EXPECT_THAT(message(config), HasSubstr("color_pose: 7 numbers"));
  config.color_pose = {0.1, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0};
  EXPECT_THAT(message(config), HasSubstr("norm 1"));
  config.color_pose.clear();
  config.genicam.color_camera_id = "10.0.0.3";
  EXPECT_THAT(message(config), HasSubstr("genicam.camera_id"));
  config.genicam.interface_address = "eth0";
  EXPECT_THAT(message(config), HasSubstr("interface_address"));
}

TEST(MakeSource, SettingsReachTheCamera) {
  SimulatedCamera camera(LoopbackAddress());
  Config config;
  config.genicam.camera_id = LoopbackAddress();
  config.genicam.exposure_s = 0.002;
  config.genicam.gain_dB = 6.0;
  config.depth.intrinsics_px = {140.0, 141.0, 70.0, 50.0};
  config.depth_unit_m = 2e-4;
  config.color.intrinsics_px = {160.0, 161.0, 90.0, 40.0};
  config.color_pose = {0.25, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  const auto source = MakeSource(config, app::LoadYaml);
  const FramePtr frame = WaitForFrame(*source, In(20.0));
  ASSERT_NE(frame, nullptr) << source->Health().reason;
  EXPECT_NEAR(frame->facts.exposure_s, 0.002, 1e-6);
  EXPECT_NEAR(frame->facts.gain_dB, 6.0, 1e-6);
  EXPECT_EQ(frame->camera->depth.fx_px, 140.0);
  EXPECT_EQ(frame->camera->depth.fy_px, 141.0);
  EXPECT_EQ(frame->camera->depth.cx_px, 70.0);
  EXPECT_EQ(frame->camera->color.fx_px, 160.0);
  EXPECT_EQ(frame->camera->color.cy_px, 40.0);
  EXPECT_EQ(frame->camera->depth_unit_m, 2e-4);
  EXPECT_EQ(frame->camera->T_depth_color.translation().x(), 0.25);
  EXPECT_LE(*std::max_element(frame->images.depth.values.begin(), frame->images.depth.values.end()),
            65535 / 2 + 1);
}

}  // namespace
}  // namespace palpate::capture
