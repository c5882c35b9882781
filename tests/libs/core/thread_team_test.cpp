// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/thread_team.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <thread>
#include <vector>

#include "libs/core/index.hpp"

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

/// With more threads than any machine wakes within a part that does nothing.
TEST(ThreadTeam, CallerTakesOverWhatOthersHaveNotBegun) {
  constexpr int kSize = 16;
  constexpr int kSections = 2000;
  ThreadTeam team(kSize);
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<int> calls(kSize, 0);
  std::vector<int> by_caller(kSize, 0);
  for (int section = 0; section < kSections; ++section) {
    team.Run([&](int index) {
      ++calls[At(index)];
      by_caller[At(index)] += std::this_thread::get_id() == caller;
    });
    for (const int count : calls) ASSERT_EQ(count, section + 1);
  }
  EXPECT_EQ(by_caller[0], kSections);
  EXPECT_GT(std::accumulate(by_caller.begin() + 1, by_caller.end(), 0), 0);
}

/// What parts write is there when Run returns, whoever ran them.
TEST(ThreadTeam, SectionsSeeWhatThoseBeforeHaveWritten) {
  constexpr int kSize = 3;
  ThreadTeam team(kSize);
  std::vector<int> left(kSize, 0);
  std::vector<int> seen(kSize, 0);
  for (int section = 1; section <= 1000; ++section) {
    team.Run([&](int index) { left[At(index)] = section; });
    team.Run([&](int index) { seen[At(index)] = std::accumulate(left.begin(), left.end(), 0); });
    for (const int sum : seen) ASSERT_EQ(sum, kSize * section);
  }
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
