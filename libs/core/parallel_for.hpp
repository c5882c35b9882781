// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace palpate {

/// Calls work(k) once for every k = 0 .. count - 1, in any order, on at most so many threads, of
/// which the caller's is one, and returns when all are done. `work` must not throw. For work of
/// milliseconds and more; ThreadTeam is for less.
template <typename Work>
void ParallelFor(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&] {
    for (std::size_t k = next++; k < count; k = next++) work(k);
  };
  std::vector<std::jthread> others;
  const auto most = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
  for (std::size_t k = 1; k < most; ++k) others.emplace_back(take);
  take();
}

}  // namespace palpate
