// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/system/bench/frame_listener.hpp"
#include "tests/system/virtual_bench.hpp"

/// A camera, or the process that reads it, dies and comes back.
namespace palpate::system_test {
namespace {

using Clock = FrameListener::Clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Times in the terms are printed; what is asserted leaves a busy machine its room.
constexpr seconds kCameraPatience{30};

// Files and threads of a connection that is being taken down beside the present one.
constexpr std::size_t kPassing = 6;

constexpr milliseconds kTakingDown{6000};

double Seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

class LostCamera : public ::testing::Test {
 protected:
  bool WaitForFrames(std::size_t count) {
    return listener_.WaitFor([&] { return listener_.CompleteCount() >= count; },
                             kCameraPatience * 2);
  }
  bool WaitForStatus(bool ok) {
    return listener_.WaitFor(
        [&] {
          return !listener_.reports().empty() && (listener_.reports().back().status == "ok") == ok;
        },
        kCameraPatience);
  }
  /// Kills the camera for so long; returns when frames come again.
  void KillFor(milliseconds pause);

  TestFolder folder_;
  FrameListener listener_;
  VirtualBench bench_{folder_, {.camera_address = "127.0.0.44"}};
};

void LostCamera::KillFor(milliseconds pause) {
  ASSERT_TRUE(WaitForFrames(5)) << bench_.capture->Output();
  const std::uint32_t epoch = listener_.LastEpoch();
  listener_.Forget();
  bench_.Kill(bench_.camera);
  const auto killed = Clock::now();
  ASSERT_TRUE(WaitForStatus(false)) << "the loss was not reported";
  const double report_s = Seconds(Clock::now() - killed);
  EXPECT_FALSE(listener_.reports().back().reason.empty());
  const auto rest = pause - (Clock::now() - killed);
  if (rest.count() > 0) listener_.ListenFor(std::chrono::duration_cast<milliseconds>(rest));
  listener_.Forget();
  bench_.StartCamera();
  const auto started = Clock::now();
  ASSERT_TRUE(WaitForFrames(1)) << bench_.capture->Output();
  const double return_s = Seconds(Clock::now() - started);
  EXPECT_GT(listener_.LastEpoch(), epoch);
  std::printf("killed for %.1f s: loss reported after %.2f s, frames %.2f s after the start\n",
              1e-3 * static_cast<double>(pause.count()), report_s, return_s);
  ASSERT_TRUE(WaitForStatus(true));
}

/// PALPATE_KILL_CYCLES=50 kills it so often, and once more for 10 s.
TEST_F(LostCamera, IsReportedAndTakenUpAgain) {
  bench_.StartAll();
  KillFor(seconds(3));
  const Process::Holdings before = bench_.capture->Holds();
  const char* cycles = std::getenv("PALPATE_KILL_CYCLES");
  for (int cycle = 0; cycle < (cycles ? std::atoi(cycles) : 0); ++cycle) KillFor(milliseconds(0));
  if (cycles) KillFor(seconds(10));
  if (cycles) listener_.ListenFor(kTakingDown);
  const Process::Holdings after = bench_.capture->Holds();
  std::printf("capture holds %zu files, %zu threads, %.1f MiB; before %zu, %zu, %.1f\n",
              after.files, after.threads, after.memory_MiB, before.files, before.threads,
              before.memory_MiB);
  EXPECT_LE(after.files, before.files + kPassing);
  EXPECT_LE(after.threads, before.threads + kPassing);
  bench_.capture->Signal(SIGTERM);
  EXPECT_EQ(bench_.capture->Wait(kCameraPatience), 0) << bench_.capture->Output();
}

TEST_F(LostCamera, ACaptureProcessThatWasKilledLocksNobodyOut) {
  bench_.StartAll();
  ASSERT_TRUE(WaitForFrames(5)) << bench_.capture->Output();
  bench_.Kill(bench_.capture);
  listener_.Forget();
  const auto started = Clock::now();
  bench_.StartCapture();
  ASSERT_TRUE(WaitForFrames(5)) << bench_.capture->Output();
  std::printf("frames %.2f s after the start of a second capture process\n",
              Seconds(listener_.LastArrival() - started));
}

}  // namespace
}  // namespace palpate::system_test
