// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "components/capture/stream/frame_pairing.hpp"
#include "components/capture/stream/frame_pool.hpp"
#include "components/capture/stream/frame_queue.hpp"

namespace palpate::capture {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::shared_ptr<SourceFrame> FrameAt(std::int64_t stamp_ns, std::uint64_t id = 0) {
  auto frame = std::make_shared<SourceFrame>();
  frame->facts.stamp_host_ns = stamp_ns;
  frame->facts.frame_id = id;
  return frame;
}

TEST(FramePool, UsesTheSameMemoryAgainAndMakesNoMoreThanItsCapacity) {
  FramePool pool(3);
  auto a = pool.Take();
  auto b = pool.Take();
  a->images.depth = rgbd::DepthImage(4, 4, 7);
  const auto* pixels = a->images.depth.values.data();
  const auto* frame = a.get();
  a.reset();
  auto again = pool.Take();
  EXPECT_EQ(again.get(), frame);
  EXPECT_EQ(again->images.depth.values.data(), pixels);
  EXPECT_EQ(pool.made(), 2u);
  auto c = pool.Take();
  EXPECT_NE(c, nullptr);
  EXPECT_EQ(pool.Take(), nullptr);
  EXPECT_EQ(pool.made(), 3u);
}

TEST(FramePool, AFrameThatAReaderHoldsIsNotWrittenTo) {
  FramePool pool(2);
  auto taken = pool.Take();
  const FramePtr reader = taken;
  taken.reset();
  EXPECT_NE(pool.Take().get(), reader.get());
}

TEST(FrameQueue, DropsTheOldestAndCounts) {
  FrameQueue queue(3);
  for (std::uint64_t i = 0; i < 10; ++i) queue.Push(FrameAt(0, i));
  EXPECT_EQ(queue.dropped(), 7u);
  for (std::uint64_t i = 7; i < 10; ++i) EXPECT_EQ(queue.Pop(0.0)->facts.frame_id, i);
  EXPECT_EQ(queue.Pop(0.0), nullptr);
}

TEST(FrameQueue, WaitingForRoomLosesNothing) {
  FrameQueue queue(2);
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < 200; ++i) ASSERT_TRUE(queue.PushWhenRoom(FrameAt(0, i)));
    queue.Close();
  });
  for (std::uint64_t i = 0; i < 200; ++i) EXPECT_EQ(queue.Pop(30.0)->facts.frame_id, i);
  EXPECT_EQ(queue.Pop(30.0), nullptr);
  EXPECT_TRUE(queue.drained());
  EXPECT_EQ(queue.dropped(), 0u);
  writer.join();
}

TEST(FrameQueue, ClosingFreesWhoWaits) {
  FrameQueue queue(1);
  queue.Push(FrameAt(0));
  std::thread writer([&] { EXPECT_FALSE(queue.PushWhenRoom(FrameAt(1))); });
  queue.Close();
  writer.join();
  EXPECT_FALSE(queue.drained());
  EXPECT_NE(queue.Pop(30.0), nullptr);
  EXPECT_EQ(queue.Pop(30.0), nullptr);
}

TEST(FramePairing, PairsByNearestTimeAndTellsTheDifference) {
  FramePairing pairing(16 * kMs);
  pairing.AddColor(FrameAt(95 * kMs, 1));
  pairing.AddColor(FrameAt(128 * kMs, 2));
  auto depth = FrameAt(100 * kMs, 11);
  pairing.AddDepth(depth);
  auto pair = pairing.Next();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ((*pair)->facts.frame_id, 11u);
  EXPECT_EQ((*pair)->facts.pairing_difference_ns, -5 * kMs);
  EXPECT_FALSE(pairing.Next().has_value());
}

TEST(FramePairing, TheColourPictureIsMovedIntoTheDepthFrame) {
  FramePairing pairing(16 * kMs);
  auto color = FrameAt(101 * kMs);
  color->images.color = rgbd::ColorImage(2, 1, 9);
  const auto* pixels = color->images.color.values.data();
  pairing.AddColor(color);
  pairing.AddDepth(FrameAt(100 * kMs));
  auto pair = pairing.Next();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ((*pair)->images.color.values.data(), pixels);
}

TEST(FramePairing, ANearerPictureThatMayStillComeIsWaitedFor) {
  FramePairing pairing(16 * kMs);
  pairing.AddColor(FrameAt(90 * kMs, 1));
  pairing.AddDepth(FrameAt(100 * kMs, 11));
  EXPECT_FALSE(pairing.Next().has_value());
  pairing.AddColor(FrameAt(102 * kMs, 2));
  auto pair = pairing.Next();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ((*pair)->facts.pairing_difference_ns, 2 * kMs);
}

TEST(FramePairing, WhatFindsNoPartnerWithinTheToleranceIsCounted) {
  FramePairing pairing(10 * kMs);
  pairing.AddDepth(FrameAt(100 * kMs));
  pairing.AddColor(FrameAt(111 * kMs));
  EXPECT_FALSE(pairing.Next().has_value());
  EXPECT_EQ(pairing.unpaired(), 1u);  // the depth frame; the colour may still find one
  pairing.AddDepth(FrameAt(110 * kMs));
  EXPECT_TRUE(pairing.Next().has_value());
}

TEST(FramePairing, APictureAPeriodLaterIsNotWaitedForWhereItCannotBeNearer) {
  FramePairing pairing(17 * kMs);
  pairing.AddColor(FrameAt(66 * kMs));
  pairing.AddColor(FrameAt(99 * kMs));
  pairing.AddDepth(FrameAt(104 * kMs));
  auto pair = pairing.Next();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ((*pair)->facts.pairing_difference_ns, -5 * kMs);
}

TEST(FramePairing, KeepsABoundedNumberWhereOneCameraIsSilent) {
  FramePairing pairing(10 * kMs, 4);
  for (int i = 0; i < 100; ++i) pairing.AddColor(FrameAt(i * 33 * kMs));
  EXPECT_EQ(pairing.unpaired(), 96u);
}

TEST(FramePairing, TwoCamerasOfTheSameRateArePairedOneToOne) {
  FramePairing pairing(17 * kMs);
  int pairs = 0;
  for (int i = 0; i < 300; ++i) {
    pairing.AddDepth(FrameAt(i * 33'333'333LL));
    // The colour camera is 4 ms late, with a wobble of 2 ms.
    pairing.AddColor(FrameAt(i * 33'333'333LL + 4 * kMs + (i % 5 - 2) * kMs));
    while (auto pair = pairing.Next()) {
      ++pairs;
      EXPECT_LE(std::abs((*pair)->facts.pairing_difference_ns), 6 * kMs);
    }
  }
  EXPECT_EQ(pairs, 300);
  EXPECT_EQ(pairing.unpaired(), 0u);
}

}  // namespace
}  // namespace palpate::capture
