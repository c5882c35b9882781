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
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace palpate::system_test {

std::optional<Holdings> HoldingsOf(pid_t pid) {
  const std::filesystem::path folder = "/proc/" + std::to_string(pid);
  std::error_code gone;
  const auto entries = [&](const char* name) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder / name, gone), {}));
  };
  Holdings holdings{.files = entries("fd"), .threads = gone ? 0 : entries("task")};
  std::ifstream stream(folder / "statm");
  double pages = 0.0;
  double resident_pages = 0.0;
  stream >> pages >> resident_pages;
  if (gone || !stream || resident_pages == 0.0) return std::nullopt;
  holdings.memory_MiB = resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
  return holdings;
}

Process::Process(const std::string& name, const std::vector<std::string>& arguments,
                 const std::filesystem::path& log, const std::vector<std::string>& wrapper)
    : log_(log) {
  const std::string program = std::string(PALPATE_BINARY_DIR) + "/bin/" + name;
  std::vector<std::string> words = wrapper;
  words.push_back(program);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  const int result = posix_spawnp(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
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

double Process::CpuTime_s() const {
  std::ifstream stream("/proc/" + std::to_string(pid_) + "/stat");
  std::string text(std::istreambuf_iterator<char>(stream), {});
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user_ticks = 0.0;
  double system_ticks = 0.0;
  fields >> user_ticks >> system_ticks;
  return (user_ticks + system_ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::string Process::Output() const {
  std::ifstream stream(log_);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::optional<int> RunProgram(const std::string& name, const std::vector<std::string>& arguments,
                              const std::filesystem::path& log) {
  return Process(name, arguments, log).Wait(std::chrono::minutes(10));
}

}  // namespace palpate::system_test
