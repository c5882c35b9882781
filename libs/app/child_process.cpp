// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::app {

namespace {

constexpr int kCannotExecute = 127;

std::vector<std::string> WithOurEnvironment(const std::map<std::string, std::string>& added) {
  std::vector<std::string> lines;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string line = *entry;
    if (!added.contains(line.substr(0, line.find('=')))) {
      lines.push_back(line);
    }
  }
  for (const auto& [name, value] : added) {
    lines.push_back(name + "=" + value);
  }
  return lines;
}

std::vector<char*> Pointers(std::vector<std::string>* lines) {
  std::vector<char*> pointers;
  for (std::string& line : *lines) {
    pointers.push_back(line.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

int ToExitCode(int wait_status) {
  return WIFSIGNALED(wait_status) ? 128 + WTERMSIG(wait_status) : WEXITSTATUS(wait_status);
}

}  // namespace

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           const std::map<std::string, std::string>& environment,
                           const std::filesystem::path& log)
    : name_(program.filename().string()), log_(log) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), program.string());
  std::vector<std::string> lines = WithOurEnvironment(environment);
  const std::vector<char*> argument_pointers = Pointers(&words);
  const std::vector<char*> environment_pointers = Pointers(&lines);
  if (access(program.c_str(), X_OK) != 0) {
    throw RunError("cannot start " + program.string() + ": " + std::strerror(errno));
  }
  const int log_file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (log_file < 0) {
    throw RunError("cannot write " + log.string() + ": " + std::strerror(errno));
  }
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    // Between fork and exec only what is safe in a signal handler: other threads may hold locks.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() == parent && dup2(log_file, STDOUT_FILENO) >= 0 &&
        dup2(log_file, STDERR_FILENO) >= 0) {
      execve(argument_pointers.front(), argument_pointers.data(), environment_pointers.data());
    }
    _exit(kCannotExecute);
  }
  const int fork_error = errno;
  close(log_file);
  if (pid_ < 0) {
    throw RunError("cannot start " + program.string() + ": " + std::strerror(fork_error));
  }
}

ChildProcess::~ChildProcess() { Stop(); }

void ChildProcess::GiveWay() {
  constexpr int kNicer = 5;
  const int niceness = getpriority(PRIO_PROCESS, 0) + kNicer;
  const int failed = setpriority(PRIO_PROCESS, static_cast<id_t>(pid_), niceness);
  PALPATE_CHECK(failed == 0 || errno == ESRCH, name_, std::strerror(errno));  // it may have ended
}

std::optional<int> ChildProcess::ExitCode() {
  int wait_status = 0;
  if (!exit_code_ && waitpid(pid_, &wait_status, WNOHANG) == pid_) {
    exit_code_ = ToExitCode(wait_status);
  }
  return exit_code_;
}

int ChildProcess::Wait() {
  int wait_status = 0;
  while (!exit_code_) {
    const pid_t ended = waitpid(pid_, &wait_status, 0);
    if (ended == pid_) {
      exit_code_ = ToExitCode(wait_status);
    } else {
      PALPATE_CHECK(errno == EINTR, name_, std::strerror(errno));
    }
  }
  return *exit_code_;
}

void ChildProcess::Interrupt() {
  if (!ExitCode()) kill(pid_, SIGINT);
}

int ChildProcess::Stop() {
  constexpr auto kPatience = std::chrono::seconds(5);
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    if (ExitCode()) {
      return *exit_code_;
    }
    kill(pid_, signal);
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!ExitCode() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return exit_code_.value_or(128 + SIGKILL);
}

}  // namespace palpate::app
