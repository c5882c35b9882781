// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/stop_signal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::app {

namespace {

/// What the handler may touch: lock-free atomics, and write() on the stop pipe.
struct HandlerState {
  std::atomic<bool> in_use{false};
  std::atomic<bool> requested{false};
  std::array<int, 2> stop_pipe{-1, -1};  // read end, write end
  std::array<int, 2> quit_pipe{-1, -1};  // ends the watcher thread
  struct sigaction interrupt_before {};
  struct sigaction terminate_before {};
};
static_assert(std::atomic<bool>::is_always_lock_free);

HandlerState g_state;

void RequestStop() {
  if (g_state.requested.exchange(true)) return;
  const char byte = 's';
  // The pipe is empty, so this cannot block or fail for want of room.
  [[maybe_unused]] const ssize_t written = write(g_state.stop_pipe[1], &byte, 1);
}

void HandleSignal(int) {
  const int errno_before = errno;
  RequestStop();
  errno = errno_before;
}

void OpenPipe(std::array<int, 2>* ends) {
  if (pipe2(ends->data(), O_CLOEXEC) == 0) return;
  throw RunError(std::string("cannot watch for signals: ") + std::strerror(errno));
}

void ClosePipe(std::array<int, 2>* ends) {
  for (int& end : *ends) {
    close(end);
    end = -1;
  }
}

void InstallHandlers() {
  struct sigaction action {};
  action.sa_handler = &HandleSignal;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &g_state.interrupt_before);
  sigaction(SIGTERM, &action, &g_state.terminate_before);
}

}  // namespace

StopSignal::StopSignal(std::function<void()> on_stop) : on_stop_(std::move(on_stop)) {
  PALPATE_CHECK(!g_state.in_use.exchange(true), "a second StopSignal");
  g_state.requested = false;
  OpenPipe(&g_state.stop_pipe);
  OpenPipe(&g_state.quit_pipe);
  try {
    watcher_ = std::thread([this] { WatchPipe(); });
  } catch (const std::system_error& error) {
    throw RunError(std::string("cannot watch for signals: ") + error.what());
  }
  InstallHandlers();
}

StopSignal::~StopSignal() {
  sigaction(SIGINT, &g_state.interrupt_before, nullptr);
  sigaction(SIGTERM, &g_state.terminate_before, nullptr);
  const char byte = 'q';
  [[maybe_unused]] const ssize_t written = write(g_state.quit_pipe[1], &byte, 1);
  watcher_.join();
  ClosePipe(&g_state.stop_pipe);
  ClosePipe(&g_state.quit_pipe);
  g_state.in_use = false;
}

bool StopSignal::Requested() const { return g_state.requested.load(); }

int StopSignal::file_descriptor() const { return g_state.stop_pipe[0]; }

void StopSignal::Wait() const {
  pollfd ends{.fd = file_descriptor(), .events = POLLIN, .revents = 0};
  while (!Requested() || (ends.revents & POLLIN) == 0) poll(&ends, 1, -1);
}

void StopSignal::Request() { RequestStop(); }

void StopSignal::WatchPipe() {
  std::array<pollfd, 2> ends{pollfd{g_state.stop_pipe[0], POLLIN, 0},
                             pollfd{g_state.quit_pipe[0], POLLIN, 0}};
  while (poll(ends.data(), ends.size(), -1) < 0 && errno == EINTR) {
  }
  if ((ends[0].revents & POLLIN) != 0 && on_stop_) on_stop_();
}

}  // namespace palpate::app
