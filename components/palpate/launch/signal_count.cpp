// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/signal_count.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

constexpr std::array<int, 3> kCountedSignals{SIGINT, SIGTERM, SIGHUP};

struct Handlers {
  std::atomic<bool> in_use{false};
  std::array<int, 2> pipe{-1, -1};
  std::array<struct sigaction, kCountedSignals.size()> before{};
};

Handlers g_handlers;

void Count(int) {
  const int errno_before = errno;
  const char byte = 's';
  [[maybe_unused]] const ssize_t written = write(g_handlers.pipe[1], &byte, 1);
  errno = errno_before;
}

}  // namespace

SignalCount::SignalCount() {
  PALPATE_CHECK(!g_handlers.in_use.exchange(true), "a second SignalCount");
  if (pipe2(g_handlers.pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
    g_handlers.in_use = false;
    throw RunError(std::string("cannot watch for signals: ") + std::strerror(errno));
  }
  struct sigaction action {};
  action.sa_handler = &Count;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kCountedSignals.size(); ++i) {
    sigaction(kCountedSignals[i], &action, &g_handlers.before[i]);
  }
}

SignalCount::~SignalCount() {
  for (std::size_t i = 0; i < kCountedSignals.size(); ++i) {
    sigaction(kCountedSignals[i], &g_handlers.before[i], nullptr);
  }
  for (int& end : g_handlers.pipe) {
    close(end);
    end = -1;
  }
  g_handlers.in_use = false;
}

int SignalCount::Take() {
  std::array<char, 64> bytes;
  const ssize_t got = read(g_handlers.pipe[0], bytes.data(), bytes.size());
  return got > 0 ? static_cast<int>(got) : 0;
}

int SignalCount::file_descriptor() const { return g_handlers.pipe[0]; }

}  // namespace palpate::command
