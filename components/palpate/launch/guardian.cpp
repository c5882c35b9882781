// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/guardian.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <ctime>
#include <string>

#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

constexpr std::size_t kMostGroups = 1024;
constexpr long kStep_ns = 50'000'000;
constexpr double kStep_s = 0.05;

// From here to Guard(): run after fork() in a process that may have had other threads, so nothing
// allocates, locks or throws.

struct Groups {
  std::array<pid_t, kMostGroups> pids{};
  std::size_t count = 0;

  void Add(pid_t pid) {
    if (count < kMostGroups) pids[count++] = pid;
  }
  void Remove(pid_t pid) {
    for (std::size_t i = 0; i < count; ++i) {
      if (pids[i] == pid) pids[i] = pids[--count];
    }
  }
  void Signal(int signal) {
    for (std::size_t i = 0; i < count; ++i) kill(-pids[i], signal);
  }
  bool AnyLeft() const {
    for (std::size_t i = 0; i < count; ++i) {
      if (kill(-pids[i], 0) == 0) return true;
    }
    return false;
  }
};

void WaitFor(const Groups& groups, double at_most_s) {
  const timespec step{.tv_sec = 0, .tv_nsec = kStep_ns};
  for (double waited_s = 0.0; waited_s < at_most_s && groups.AnyLeft(); waited_s += kStep_s) {
    nanosleep(&step, nullptr);
  }
}

[[noreturn]] void Guard(int read_end, const StopPlan& stop) {
  setsid();  // no Ctrl-C of the terminal
  prctl(PR_SET_NAME, "palpate-guard");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_IGN);
  if (read_end != STDIN_FILENO) dup2(read_end, STDIN_FILENO);
  close_range(STDERR_FILENO + 1, UINT_MAX, 0);
  close(STDOUT_FILENO);  // who reads this process's output does not wait for this one
  close(STDERR_FILENO);
  Groups groups;
  for (pid_t word = 0;;) {
    const ssize_t got = read(STDIN_FILENO, &word, sizeof(word));
    if (got < 0 && errno == EINTR) continue;
    if (got != static_cast<ssize_t>(sizeof(word))) break;
    if (word > 0) {
      groups.Add(word);
    } else {
      groups.Remove(-word);
    }
  }
  groups.Signal(SIGINT);
  WaitFor(groups, stop.interrupt_s);
  groups.Signal(SIGTERM);
  WaitFor(groups, stop.terminate_s);
  groups.Signal(SIGKILL);
  _exit(0);
}

}  // namespace

Guardian::Guardian(const StopPlan& stop) {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw RunError(std::string("cannot watch over processes: ") + std::strerror(errno));
  }
  pid_ = fork();
  if (pid_ == 0) {
    close(ends[1]);
    Guard(ends[0], stop);
  }
  const int cause = errno;
  close(ends[0]);
  pipe_ = ends[1];
  if (pid_ > 0) return;
  close(pipe_);
  throw RunError(std::string("cannot watch over processes: ") + std::strerror(cause));
}

Guardian::~Guardian() {
  close(pipe_);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Guardian::Watch(pid_t process_group) { Tell(process_group); }

void Guardian::Forget(pid_t process_group) { Tell(-process_group); }

void Guardian::Tell(pid_t word) {
  // Less than PIPE_BUF: written as a whole or not at all. A guardian that was killed is missed by
  // nobody while this process lives.
  [[maybe_unused]] const ssize_t written = write(pipe_, &word, sizeof(word));
}

}  // namespace palpate::command
