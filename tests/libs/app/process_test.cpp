// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <future>

#include "libs/app/log.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"

namespace palpate::app {
namespace {

using ::testing::HasSubstr;

bool IsReadable(int file_descriptor) {
  pollfd end{.fd = file_descriptor, .events = POLLIN, .revents = 0};
  return poll(&end, 1, 0) == 1;
}

TEST(StopSignal, StartsUnrequested) {
  const StopSignal stop;
  EXPECT_FALSE(stop.Requested());
  EXPECT_FALSE(IsReadable(stop.file_descriptor()));
}

TEST(StopSignal, InterruptAndTerminateSetFlagPipeAndCallback) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::promise<void> called;
    StopSignal stop([&] { called.set_value(); });
    raise(signal);
    stop.Wait();
    EXPECT_TRUE(stop.Requested());
    EXPECT_TRUE(IsReadable(stop.file_descriptor()));
    called.get_future().wait();
  }
}

TEST(StopSignal, RequestStopsAsASignalDoesAndCallsBackOnce) {
  std::atomic<int> calls{0};
  {
    StopSignal stop([&] { ++calls; });
    stop.Request();
    stop.Request();
    stop.Wait();
    EXPECT_TRUE(stop.Requested());
  }
  EXPECT_LE(calls, 1);
}

TEST(StopSignal, ThreadsThatWaitAreWoken) {
  StopSignal stop;
  auto waiting = std::async(std::launch::async, [&] { stop.Wait(); });
  stop.Request();
  waiting.get();
}

TEST(StopSignal, GivesTheSignalsBack) {
  struct sigaction before {};
  struct sigaction after {};
  sigaction(SIGTERM, nullptr, &before);
  { const StopSignal stop; }
  sigaction(SIGTERM, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
}

TEST(StopSignalDeathTest, ASecondSignalEndsTheProcessAtOnce) {
  const auto interrupt_twice = [] {
    const StopSignal stop;
    raise(SIGINT);
    raise(SIGINT);
  };
  EXPECT_EXIT(interrupt_twice(), ::testing::KilledBySignal(SIGINT), "");
}

/// A datagram socket outside the file system, as systemd listens on one.
class NotifyTest : public ::testing::Test {
 protected:
  NotifyTest() : handle_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const std::string name = "palpate_notify_test_" + std::to_string(getpid());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(&address.sun_path[1], name.size());
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    EXPECT_EQ(bind(handle_, reinterpret_cast<const sockaddr*>(&address), length), 0);
    setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
  }
  ~NotifyTest() override {
    unsetenv("NOTIFY_SOCKET");
    close(handle_);
  }

  std::string Receive() const {
    std::array<char, 64> buffer{};
    const ssize_t size = recv(handle_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    return size < 0 ? "nothing" : std::string(buffer.data(), static_cast<size_t>(size));
  }

  int handle_;
};

TEST_F(NotifyTest, SendsTheWordsThatSystemdKnows) {
  NotifyReady();
  EXPECT_EQ(Receive(), "READY=1");
  NotifyWatchdog();
  EXPECT_EQ(Receive(), "WATCHDOG=1");
  NotifyStopping();
  EXPECT_EQ(Receive(), "STOPPING=1");
}

TEST_F(NotifyTest, DoesNothingWithoutSystemd) {
  unsetenv("NOTIFY_SOCKET");
  NotifyReady();
  EXPECT_EQ(Receive(), "nothing");
}

TEST_F(NotifyTest, SaysWhyASocketCannotBeReached) {
  for (const std::string& path :
       {std::string("/nowhere/socket"), std::string("relative"), "/" + std::string(200, 'x')}) {
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    EXPECT_THROW(NotifyReady(), RunError) << path;
  }
}

TEST(Log, StartsWithVersionFileHashAndDomain) {
  NodeOptions options;
  options.config_file = "a.yaml";
  options.config_sha256 = "0123456789abcdef";
  options.domain_id = 7;
  ::testing::internal::CaptureStderr();
  StartLog("palpate-x", options);
  LogDebug("not {}", "shown");
  LogWarning("{} frames lost", 3);
  const std::string printed = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(printed, HasSubstr(std::string("[info] palpate-x: version ") + Version() +
                                 ", settings a.yaml (sha256 0123456789ab), domain 7\n"));
  EXPECT_THAT(printed, HasSubstr("[warning] palpate-x: 3 frames lost\n"));
  EXPECT_THAT(printed, ::testing::Not(HasSubstr("shown")));
}

}  // namespace
}  // namespace palpate::app
