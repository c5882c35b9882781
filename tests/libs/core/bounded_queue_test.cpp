// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace palpate {
namespace {

TEST(BoundedQueue, OfTheOvertakableItemsOnlyTheNewestWaits) {
  BoundedQueue<int> queue(10);
  queue.Push(1, true);
  queue.Push(2, false);
  queue.Push(3, true);
  queue.Push(4, true);
  EXPECT_EQ(queue.TryPop(), 2);
  EXPECT_EQ(queue.TryPop(), 4);
  EXPECT_EQ(queue.TryPop(), std::nullopt);
  EXPECT_EQ(queue.dropped(), 2u);
}

TEST(BoundedQueue, NeverHoldsMoreThanItsCapacityAndLosesTheOldest) {
  BoundedQueue<int> queue(3);
  for (int i = 0; i < 5; ++i) queue.Push(i, false);
  EXPECT_EQ(queue.TryPop(), 2);
  EXPECT_EQ(queue.dropped(), 2u);
}

TEST(BoundedQueue, StopEndsAWaitEvenWhereItemsWait) {
  BoundedQueue<int> queue(3);
  std::optional<int> popped = 7;
  std::thread waiting([&] { popped = queue.Pop(); });
  queue.Stop();
  waiting.join();
  EXPECT_EQ(popped, std::nullopt);
  queue.Push(1, false);
  EXPECT_EQ(queue.Pop(), std::nullopt);
}

TEST(BoundedQueue, WhatOneThreadPushesTheOtherGetsInOrder) {
  BoundedQueue<int> queue(1000);
  std::thread pushing([&] {
    for (int i = 0; i < 500; ++i) queue.Push(i, false);
  });
  for (int i = 0; i < 500; ++i) ASSERT_EQ(queue.Pop(), i);
  pushing.join();
}

TEST(BoundedQueue, WhereItWaitsForRoomNothingIsLost) {
  BoundedQueue<int> queue(2);
  std::thread pushing([&] {
    for (int i = 0; i < 500; ++i) EXPECT_TRUE(queue.PushWhenRoom(i));
  });
  for (int i = 0; i < 500; ++i) ASSERT_EQ(queue.Pop(), i);
  pushing.join();
  EXPECT_EQ(queue.dropped(), 0u);
}

TEST(BoundedQueue, StopEndsAWaitForRoom) {
  BoundedQueue<int> queue(1);
  ASSERT_TRUE(queue.PushWhenRoom(1));
  bool pushed = true;
  std::thread pushing([&] { pushed = queue.PushWhenRoom(2); });
  queue.Stop();
  pushing.join();
  EXPECT_FALSE(pushed);
}

}  // namespace
}  // namespace palpate
