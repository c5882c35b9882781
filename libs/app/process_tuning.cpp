// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/process_tuning.hpp"

#include <malloc.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace palpate::app {

namespace {

/// Larger blocks of memory go back to the system at once; glibc's limit for the first is 32 MB.
constexpr int kReusedBytes = 32 << 20;

constexpr std::uint64_t kShortestTurn_ns = 100'000;  // of Linux
constexpr std::uint64_t kNotInherited = 1;           // SCHED_FLAG_RESET_ON_FORK

/// As the kernel lays it out (sched_setattr(2)); glibc has it from 2.41 on.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;    ///< of SCHED_RR
  std::uint64_t runtime_ns = 0;  ///< of SCHED_OTHER: length of a turn; 0: the system's
  std::uint64_t deadline_ns = 0;
  std::uint64_t period_ns = 0;
};

bool Schedule(const SchedulingAttributes& attributes) {
  return syscall(SYS_sched_setattr, 0, &attributes, 0) == 0;
}

}  // namespace

void KeepLargeBlocks() {
  mallopt(M_MMAP_THRESHOLD, kReusedBytes);
  mallopt(M_TRIM_THRESHOLD, kReusedBytes);
}

void PreferPromptWakeUps() {
  SchedulingAttributes real_time;
  real_time.policy = SCHED_RR;
  real_time.priority = 1;
  real_time.flags = kNotInherited;
  if (Schedule(real_time)) return;
  SchedulingAttributes short_turns;
  short_turns.nice = getpriority(PRIO_PROCESS, 0);
  short_turns.runtime_ns = kShortestTurn_ns;
  short_turns.flags = kNotInherited;
  Schedule(short_turns);  // earlier systems have no such choice
}

void EndPromptWakeUps() {
  SchedulingAttributes usual;
  usual.nice = getpriority(PRIO_PROCESS, 0);
  usual.flags = kNotInherited;  // only root may clear it
  Schedule(usual);
}

}  // namespace palpate::app
