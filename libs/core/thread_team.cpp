// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/thread_team.hpp"

#include <algorithm>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate {

namespace {

using TeamClock = std::chrono::steady_clock;

/// Parts are about equal: who waits longer than for its own part waits for a busy core. Shorter
/// waits cost less than working alone.
constexpr std::chrono::microseconds kLongWait(200);
constexpr int kAlone = 20;  // times the wait

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

ThreadTeam::ThreadTeam(int size) : begun_(static_cast<size_t>(std::max(size, 1))) {
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

bool ThreadTeam::Begin(int index, unsigned section) {
  unsigned before = section - 1;
  return begun_[At(index)].section.compare_exchange_strong(before, section,
                                                           std::memory_order_relaxed);
}

void ThreadTeam::RunErased(Function function, const void* context) {
  const TeamClock::time_point begin = TeamClock::now();
  if (begin < alone_until_) {
    for (int index = 0; index < Size(); ++index) function(context, index);
    return;
  }
  function_ = function;
  context_ = context;
  running_.store(Size() - 1, std::memory_order_relaxed);
  const unsigned section = section_.fetch_add(1, std::memory_order_release) + 1;
  section_.notify_all();
  function(context, 0);
  for (int index = 1; index < Size(); ++index) {
    if (!Begin(index, section)) continue;
    function(context, index);
    running_.fetch_sub(1, std::memory_order_relaxed);
  }
  const TeamClock::time_point done = TeamClock::now();
  for (int left = running_.load(std::memory_order_acquire); left != 0;
       left = running_.load(std::memory_order_acquire)) {
    WaitForChange(running_, left);
  }
  const TeamClock::time_point end = TeamClock::now();
  if (end - done > (done - begin) + kLongWait) alone_until_ = end + kAlone * (end - done);
}

void ThreadTeam::Work(int index) {
  for (unsigned seen = 0;;) {
    WaitForChange(section_, seen);
    seen = section_.load(std::memory_order_acquire);
    if (stop_.load(std::memory_order_relaxed)) return;
    // A section that ended meanwhile has no part left: every part of it was begun.
    if (!Begin(index, seen)) continue;
    function_(context_, index);
    if (running_.fetch_sub(1, std::memory_order_acq_rel) == 1) running_.notify_one();
  }
}

}  // namespace palpate
