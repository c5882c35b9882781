// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <vector>

namespace palpate::blind {

/// Calls `work` with 0, 1, 2, ..., two of them at any time, until one gives false; those that have
/// begun then are waited for. What one throws comes out of here.
inline void TwoAtATime(const std::function<bool(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> goes_on = true;
  const auto one_after_another = [&] {
    while (goes_on) {
      try {
        if (!work(next++)) goes_on = false;
      } catch (...) {
        goes_on = false;
        throw;
      }
    }
  };
  std::vector<std::future<void>> workers;
  for (int k = 0; k < 2; ++k) {
    workers.push_back(std::async(std::launch::async, one_after_another));
  }
  for (std::future<void>& worker : workers) worker.get();
}

}  // namespace palpate::blind
