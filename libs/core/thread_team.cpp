// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/thread_team.hpp"

#include "libs/core/check.hpp"

namespace palpate {

namespace {

inline void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Returns when `value` is no longer `old`. Sleeps after some tenths of a millisecond: longer than
/// threads of one section, and the sections of one frame, are apart, shorter than the time between
/// two frames. Most of that time it lets others run on its core, such as the thread it waits for.
template <typename T>
void WaitForChange(const std::atomic<T>& value, T old) {
  constexpr int kLooks = 2000;
  constexpr int kPatientLooks = 1000;
  for (int look = 0; look < kLooks + kPatientLooks; ++look) {
    if (value.load(std::memory_order_acquire) != old) return;
    if (look < kLooks) {
      Pause();
    } else {
      std::this_thread::yield();
    }
  }
  while (value.load(std::memory_order_acquire) == old) value.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadTeam::ThreadTeam(int size) {
  PALPATE_CHECK(size >= 1, size);
  workers_.reserve(static_cast<size_t>(size) - 1);
  for (int index = 1; index < size; ++index) {
    workers_.emplace_back([this, index] { Work(index); });
  }
}

ThreadTeam::~ThreadTeam() {
  stop_.store(true, std::memory_order_relaxed);
  section_.fetch_add(1, std::memory_order_release);
  section_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadTeam::RunErased(Function function, const void* context) {
  function_ = function;
  context_ = context;
  running_.store(Size() - 1, std::memory_order_relaxed);
  section_.fetch_add(1, std::memory_order_release);
  section_.notify_all();
  function(context, 0);
  for (int left = running_.load(std::memory_order_acquire); left != 0;
       left = running_.load(std::memory_order_acquire)) {
    WaitForChange(running_, left);
  }
}

void ThreadTeam::Work(int index) {
  for (unsigned seen = 0;; ++seen) {
    WaitForChange(section_, seen);
    if (stop_.load(std::memory_order_relaxed)) return;
    function_(context_, index);
    if (running_.fetch_sub(1, std::memory_order_acq_rel) == 1) running_.notify_one();
  }
}

void ThreadTeam::Barrier() {
  if (workers_.empty()) return;
  const unsigned opened = barrier_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == Size()) {
    arrived_.store(0, std::memory_order_relaxed);
    barrier_.fetch_add(1, std::memory_order_release);
    barrier_.notify_all();
    return;
  }
  WaitForChange(barrier_, opened);
}

}  // namespace palpate
