// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "components/capture/genicam_source.hpp"
#include "tests/components/capture/simulated_camera.hpp"

namespace palpate::capture {
namespace {

constexpr const char* kAddressVariable = "PALPATE_TEST_CAMERA";

GenicamSettings TakenOverAt(const std::string& address) {
  GenicamSettings settings;
  settings.depth.target.id = address;
  return settings;
}

/// Not a test: what the child process below does, until it is killed.
TEST(TakeOver, DISABLED_HoldTheCamera) {
  const char* address = std::getenv(kAddressVariable);
  ASSERT_NE(address, nullptr);
  GenicamSource source(TakenOverAt(address));
  while (true) source.Next(1.0);
}

/// This very program once more, holding the camera.
pid_t SpawnHolder(const std::string& address) {
  setenv(kAddressVariable, address.c_str(), 1);
  std::string program = "/proc/self/exe";
  std::string filter = "--gtest_filter=TakeOver.DISABLED_HoldTheCamera";
  std::string disabled = "--gtest_also_run_disabled_tests";
  char* arguments[] = {program.data(), filter.data(), disabled.data(), nullptr};
  pid_t child = -1;
  EXPECT_EQ(posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ), 0);
  return child;
}

TEST(TakeOver, AKilledProgramDoesNotLockTheNextOneOut) {
  SimulatedCamera camera(LoopbackAddress());
  const pid_t holder = SpawnHolder(LoopbackAddress());
  ASSERT_GT(holder, 0);
  const Deadline deadline = In(30.0);
  while (!camera.device().streaming() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  ASSERT_TRUE(camera.device().streaming());
  GenicamSource source(TakenOverAt(LoopbackAddress()));
  EXPECT_TRUE(WaitForHealth(source, In(30.0), [](const SourceHealth& health) {
    return health.reason.find("another program controls the camera") == 0;
  }));
  EXPECT_EQ(source.Next(0.0), nullptr);
  kill(holder, SIGKILL);
  int status = 0;
  waitpid(holder, &status, 0);
  const FramePtr frame = WaitForFrame(source, In(30.0));
  ASSERT_NE(frame, nullptr) << source.Health().reason;
  EXPECT_EQ(frame->images.depth,
            PatternFrame(camera.camera(), frame->images.depth.values[0]).depth);
}

std::size_t OpenFiles() {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    ++count;
  }
  return count;
}

TEST(TakeOver, OpeningAgainAndAgainLeaksNoFilesAndNoThreads) {
  const auto threads = [] {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry :
         std::filesystem::directory_iterator("/proc/self/task")) {
      ++count;
    }
    return count;
  };
  SimulatedCamera camera(LoopbackAddress());
  const auto once = [&] {
    GenicamSource source(TakenOverAt(LoopbackAddress()));
    ASSERT_NE(WaitForFrame(source, In(20.0)), nullptr) << source.Health().reason;
  };
  for (int i = 0; i < 3; ++i) once();
  const std::size_t files = OpenFiles();
  const std::size_t tasks = threads();
  for (int i = 0; i < 15; ++i) once();
  EXPECT_LE(OpenFiles(), files);
  EXPECT_LE(threads(), tasks);
}

}  // namespace
}  // namespace palpate::capture
