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
