// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/bench/streaming.hpp"

#include <gmock/gmock.h>
#include <signal.h>

/// Frames of the virtual camera through GigE Vision, Aravis, palpate-capture and DDS.
namespace palpate::system_test {
namespace {

/// `count` is at least `share` of `whole`.
void ExpectShare(std::size_t count, double share, std::size_t whole) {
  ASSERT_GT(whole, 0u);
  EXPECT_GE(static_cast<double>(count), share * static_cast<double>(whole));
}

/// A whole set with the camera's number `frame_id`.
FrameListener::FrameSet Whole(std::uint64_t frame_id) {
  FrameListener::FrameSet set;
  set.depth.emplace();
  set.color.emplace();
  set.has_info = true;
  set.frame_id = frame_id;
  return set;
}

TEST(CountFrames, ASetThatIsCutByWhenOneListensIsNoLoss) {
  FrameListener::FrameSets frames;
  frames[0].depth.emplace();
  for (int i = 1; i < 20; ++i) frames[i * 33'000'000] = Whole(11 + i);
  frames[20 * 33'000'000].depth.emplace();
  const Streamed streamed = CountFrames(frames, {});
  EXPECT_EQ(streamed.frames, 18u);
  EXPECT_EQ(streamed.sent, 18u);
  EXPECT_EQ(streamed.incomplete, 0u);
}

TEST(CountFrames, WhatIsMissedBetweenIsALoss) {
  FrameListener::FrameSets frames;
  for (int i = 0; i < 20; ++i) {
    if (i != 5) frames[i * 33'000'000] = Whole(11 + i);
  }
  frames[9 * 33'000'000].color.reset();
  frames[1 * 33'000'000] = {};
  const Streamed streamed = CountFrames(frames, {2 * 33'000'000, 3 * 33'000'000});
  EXPECT_EQ(streamed.sent, 16u);
  EXPECT_EQ(streamed.frames, 14u);
  EXPECT_EQ(streamed.incomplete, 2u);
  EXPECT_EQ(streamed.states, 2u);
}

TEST(VirtualBench, StreamsWholeFrameSets) {
  const TestFolder folder;
  FrameListener listener;
  VirtualBench bench(folder, {.camera_address = "127.0.0.41", .noise = "stereo"});
  const Streamed streamed = Stream(bench, listener, "no loss");
  ASSERT_GT(streamed.frames, 0u);
  for (auto* process : {&bench.capture, &bench.camera, &bench.robot}) {
    (*process)->Signal(SIGTERM);
    EXPECT_EQ((*process)->Wait(std::chrono::seconds(30)), 0) << (*process)->Output();
  }
  if (const std::string trouble = KernelTrouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  EXPECT_EQ(streamed.incomplete, 0u);
  ExpectShare(streamed.frames, 0.98, streamed.sent);
}

/// PALPATE_STREAM_SECONDS=32 watches it through: whether it keeps real time is printed, not
/// asserted.
TEST(VirtualBench, StreamsTheShippedScenario) {
  const TestFolder folder;
  FrameListener listener;
  VirtualBench bench(folder, {.camera_address = "127.0.0.45",
                              .scenario = PALPATE_SOURCE_DIR "/config/scenarios/pushes.yaml"});
  const Streamed streamed = Stream(bench, listener, "config/scenarios/pushes.yaml");
  ASSERT_GT(streamed.frames, 0u);
  if (const std::string trouble = KernelTrouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  EXPECT_EQ(streamed.incomplete, 0u);
  ExpectShare(streamed.frames, 0.98, streamed.sent);
}

TEST(VirtualBench, LosesNoFrameWithOnePercentOfPacketsLost) {
  const TestFolder folder;
  FrameListener listener;
  VirtualBench bench(folder, {.camera_address = "127.0.0.42", .loss = 0.01});
  const Streamed streamed = Stream(bench, listener, "1 % of packets lost");
  ASSERT_GT(streamed.frames, 0u);
  if (const std::string trouble = KernelTrouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  EXPECT_EQ(streamed.incomplete, 0u);
  ExpectShare(streamed.frames, 0.99, streamed.sent);
}

TEST(VirtualBench, KeepsTheRateWithFivePercentOfPacketsLost) {
  const TestFolder folder;
  FrameListener listener;
  VirtualBench bench(folder, {.camera_address = "127.0.0.43", .loss = 0.05});
  const Streamed streamed = Stream(bench, listener, "5 % of packets lost");
  ASSERT_GT(streamed.frames, 0u);
  if (const std::string trouble = KernelTrouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  ExpectShare(streamed.frames, 28.0 / 30.0, streamed.sent);
}

}  // namespace
}  // namespace palpate::system_test
