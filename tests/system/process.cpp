// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace palpate::system_test {

Process::Process(const std::string& name, const std::vector<std::string>& arguments,
                 const std::filesystem::path& log)
    : log_(log) {
  const std::string program = std::string(PALPATE_BINARY_DIR) + "/bin/" + name;
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  const int result = posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (result != 0) throw std::runtime_error("cannot start " + program);
}

Process::~Process() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Process::Signal(int signal) {
  if (pid_ > 0) kill(pid_, signal);
}

std::optional<int> Process::Wait(std::chrono::seconds at_most) {
  const int process = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  pollfd ended{process, POLLIN, 0};
  const auto timeout = std::chrono::duration_cast<std::chrono::milliseconds>(at_most);
  const bool has_ended = poll(&ended, 1, static_cast<int>(timeout.count())) == 1;
  close(process);
  if (!has_ended) return std::nullopt;
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::string Process::Output() const {
  std::ifstream stream(log_);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::optional<int> RunProgram(const std::string& name, const std::vector<std::string>& arguments,
                              const std::filesystem::path& log) {
  return Process(name, arguments, log).Wait(std::chrono::minutes(2));
}

}  // namespace palpate::system_test
