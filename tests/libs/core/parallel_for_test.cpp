// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <vector>

namespace palpate {
namespace {

TEST(ParallelFor, CallsEachOnce) {
  for (const int threads : {-1, 1, 2, 7}) {
    std::vector<std::atomic<int>> calls(5);
    ParallelFor(calls.size(), threads, [&](std::size_t k) { ++calls[k]; });
    for (const auto& one : calls) EXPECT_EQ(one.load(), 1) << threads << " threads";
  }
}

TEST(ParallelFor, OfNothingCallsNothing) {
  ParallelFor(0, 3, [](std::size_t) { FAIL(); });
}

/// Each waits for the others, which one thread could not.
TEST(ParallelFor, WorksAtOnce) {
  std::latch begun(3);
  ParallelFor(3, 3, [&](std::size_t) { begun.arrive_and_wait(); });
}

}  // namespace
}  // namespace palpate
