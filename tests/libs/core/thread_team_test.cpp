// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/thread_team.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace palpate {
namespace {

TEST(ThreadTeam, RunsEachIndexOncePerSection) {
  for (const int size : {1, 2, 3, 5}) {
    ThreadTeam team(size);
    ASSERT_EQ(team.Size(), size);
    std::vector<int> calls(static_cast<size_t>(size), 0);
    for (int section = 0; section < 200; ++section) {
      team.Run([&](int index) { ++calls[static_cast<size_t>(index)]; });
    }
    EXPECT_EQ(calls, std::vector<int>(static_cast<size_t>(size), 200));
  }
}

TEST(ThreadTeam, BarrierSeparatesWhatIsWrittenFromWhatIsRead) {
  constexpr int kSize = 3;
  ThreadTeam team(kSize);
  std::vector<int> left(kSize, 0);
  int wrong = 0;
  for (int section = 1; section <= 100; ++section) {
    std::vector<int> seen(kSize, 0);
    team.Run([&](int index) {
      left[static_cast<size_t>(index)] = section;
      team.Barrier();
      for (const int value : left) seen[static_cast<size_t>(index)] += value;
      team.Barrier();
    });
    for (const int sum : seen) wrong += sum != kSize * section;
  }
  EXPECT_EQ(wrong, 0);
}

TEST(ThreadTeam, WakesAgainAfterALongRest) {
  ThreadTeam team(2);
  std::vector<int> calls(2, 0);
  const auto work = [&](int index) { ++calls[static_cast<size_t>(index)]; };
  team.Run(work);
  // Longer than the workers look before they sleep.
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
  while (std::chrono::steady_clock::now() < until) std::this_thread::yield();
  team.Run(work);
  EXPECT_EQ(calls, (std::vector<int>{2, 2}));
}

TEST(ThreadTeamDeathTest, NeedsAtLeastOneThread) { EXPECT_DEATH(ThreadTeam(0), "size"); }

}  // namespace
}  // namespace palpate
