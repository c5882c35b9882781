// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/bench/streaming.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace palpate::system_test {

namespace {

using std::chrono::seconds;

/// Stamps of frames lie on the states' to within the error of the camera's clock.
constexpr std::int64_t kSameStamp_ns = 2'000'000;

constexpr long kReceiveBuffer_bytes = 2'097'152;

/// Processor time of the bench's processes.
struct Used {
  explicit Used(const VirtualBench& bench)
      : at{FrameListener::Clock::now()},
        capture_s{bench.capture->CpuTime_s()},
        camera_s{bench.camera->CpuTime_s()},
        robot_s{bench.robot->CpuTime_s()} {}

  FrameListener::Clock::time_point at;
  double capture_s;
  double camera_s;
  double robot_s;
};

void Print(const std::string& name, const Streamed& streamed, const Used& before,
           const Used& after) {
  const double percent = 100.0 / std::chrono::duration<double>(after.at - before.at).count();
  std::printf(
      "%s: %zu frames of %zu sent, %zu states, in %.1f s (%.2f a second); of a core: capture "
      "%.1f %%, camera %.1f %%, robot %.1f %%\n",
      name.c_str(), streamed.frames, streamed.sent, streamed.states, streamed.span_s,
      streamed.rate_hz(), percent * (after.capture_s - before.capture_s),
      percent * (after.camera_s - before.camera_s), percent * (after.robot_s - before.robot_s));
}

}  // namespace

seconds StreamTime() {
  const char* text = std::getenv("PALPATE_STREAM_SECONDS");
  return seconds(text ? std::atoi(text) : 6);
}

std::string KernelTrouble() {
  long most_bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> most_bytes;
  if (most_bytes >= kReceiveBuffer_bytes) return {};
  return "net.core.rmem_max is " + std::to_string(most_bytes) +
         ", too little for pictures over DDS: sudo sysctl -w net.core.rmem_max=" +
         std::to_string(kReceiveBuffer_bytes);
}

Streamed CountFrames(const FrameListener::FrameSets& frames, const std::set<std::int64_t>& states) {
  Streamed streamed;
  if (frames.size() < 5) return streamed;
  const FrameListener::FrameSets watched(std::next(frames.begin()), std::prev(frames.end(), 2));
  for (const auto& [stamp_ns, set] : watched) {
    ++(set.complete() ? streamed.frames : streamed.incomplete);
  }
  const auto told = [](const auto& entry) { return entry.second.has_info; };
  const auto first = std::find_if(watched.begin(), watched.end(), told);
  const auto last = std::find_if(watched.rbegin(), watched.rend(), told);
  if (first == watched.end()) return streamed;
  streamed.sent = last->second.frame_id - first->second.frame_id + 1;
  streamed.states =
      static_cast<std::size_t>(std::distance(states.upper_bound(first->first - kSameStamp_ns),
                                             states.lower_bound(last->first + kSameStamp_ns)));
  streamed.span_s = 1e-9 * static_cast<double>(last->first - first->first);
  return streamed;
}

Streamed Stream(VirtualBench& bench, FrameListener& listener, const std::string& name) {
  bench.StartAll();
  const bool streams =
      listener.WaitFor([&] { return listener.CompleteCount() >= 10; }, seconds(60));
  EXPECT_TRUE(streams) << bench.robot->Output() << bench.camera->Output()
                       << bench.capture->Output();
  if (!streams) return {};
  listener.Forget();
  const Used before(bench);
  listener.ListenFor(StreamTime());
  const Used after(bench);
  const Streamed streamed = CountFrames(listener.frames(), listener.states());
  Print(name, streamed, before, after);
  return streamed;
}

}  // namespace palpate::system_test
