// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/child.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

constexpr char kNotifySocket[] = "NOTIFY_SOCKET";
constexpr int kCannotExecute = 127;

/// Closes what it holds.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  int Release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

[[noreturn]] void Fail(const ChildCommand& command, int cause) {
  throw RunError("cannot start " + command.program.string() + ": " + std::strerror(cause));
}

std::vector<std::string> Environment(const std::map<std::string, std::string>& added) {
  std::vector<std::string> lines;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string line = *entry;
    const std::string name = line.substr(0, line.find('='));
    if (!added.contains(name)) lines.push_back(line);
  }
  for (const auto& [name, value] : added) lines.push_back(name + "=" + value);
  return lines;
}

std::vector<char*> Pointers(std::vector<std::string>* lines) {
  std::vector<char*> pointers;
  for (std::string& line : *lines) pointers.push_back(line.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// A socket in the abstract namespace: nothing is left of it in the file system.
int OpenNotifySocket(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path + 1, sizeof(address.sun_path) - 1);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int handle = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (handle >= 0 && bind(handle, reinterpret_cast<const sockaddr*>(&address), length) == 0) {
    return handle;
  }
  const int cause = errno;
  if (handle >= 0) close(handle);
  throw RunError(std::string("cannot open a socket for READY: ") + std::strerror(cause));
}

/// What the new process needs between fork and exec, where nothing may allocate.
struct Preparation {
  pid_t parent;
  int input;
  int output;
  int report;  // takes errno where exec fails
  int niceness;
  char* const* arguments;
  char* const* environment;
};

[[noreturn]] void Become(const Preparation& prepared) {
  // The guardian follows with stronger signals.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGHUP, SIGPIPE}) {
    std::signal(signal, SIG_DFL);
  }
  if (prepared.niceness != 0) setpriority(PRIO_PROCESS, 0, prepared.niceness);
  if (getppid() == prepared.parent && dup2(prepared.input, STDIN_FILENO) >= 0 &&
      dup2(prepared.output, STDOUT_FILENO) >= 0 && dup2(prepared.output, STDERR_FILENO) >= 0) {
    execve(prepared.arguments[0], prepared.arguments, prepared.environment);
  }
  const int cause = errno;
  [[maybe_unused]] const ssize_t written = write(prepared.report, &cause, sizeof(cause));
  _exit(kCannotExecute);
}

}  // namespace

Child::Child(const ChildCommand& command, int number) {
  const std::string socket_name = fmt::format("palpate-launch-{}-{}", getpid(), number);
  Descriptor notify(OpenNotifySocket(socket_name));
  auto environment = command.environment;
  environment[kNotifySocket] = "@" + socket_name;
  std::vector<std::string> lines = Environment(environment);
  std::vector<std::string> words = command.arguments;
  words.insert(words.begin(), command.program.string());
  const std::vector<char*> argument_pointers = Pointers(&words);
  const std::vector<char*> environment_pointers = Pointers(&lines);
  std::array<int, 2> output{-1, -1};
  std::array<int, 2> report{-1, -1};
  const Descriptor input(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (input.get() < 0 || pipe2(output.data(), O_CLOEXEC) != 0) Fail(command, errno);
  Descriptor read_end(output[0]);
  Descriptor write_end(output[1]);
  if (pipe2(report.data(), O_CLOEXEC) != 0) Fail(command, errno);
  const Descriptor report_read(report[0]);
  Descriptor report_write(report[1]);
  fcntl(read_end.get(), F_SETFL, O_NONBLOCK);
  const int niceness = command.nice == 0 ? 0 : getpriority(PRIO_PROCESS, 0) + command.nice;
  const Preparation prepared{getpid(),
                             input.get(),
                             write_end.get(),
                             report_write.get(),
                             niceness,
                             argument_pointers.data(),
                             environment_pointers.data()};
  pid_ = fork();
  if (pid_ == 0) Become(prepared);
  if (pid_ < 0) Fail(command, errno);
  setpgid(pid_, pid_);  // here, too: whoever comes first
  close(report_write.Release());
  int cause = 0;
  ssize_t got = 0;
  while ((got = read(report_read.get(), &cause, sizeof(cause))) < 0 && errno == EINTR) {
  }
  if (got > 0) {
    waitpid(pid_, nullptr, 0);
    Fail(command, cause);
  }
  output_ = read_end.Release();
  notify_ = notify.Release();
}

Child::~Child() {
  if (!ended_) {
    Signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(output_);
  close(notify_);
}

std::optional<std::string> Child::ReadOutput() {
  std::string text;
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t got = read(output_, buffer.data(), buffer.size());
    if (got > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(got));
      // The others want their turn, too.
      if (text.size() >= buffer.size()) return text;
    } else if (got == 0) {
      return text.empty() ? std::nullopt : std::optional(text);
    } else if (errno != EINTR) {
      return text;
    }
  }
}

bool Child::ReadReady() {
  bool ready = false;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t got = recv(notify_, buffer.data(), buffer.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return ready;
    std::istringstream lines(std::string(buffer.data(), static_cast<std::size_t>(got)));
    for (std::string line; std::getline(lines, line);) ready = ready || line == "READY=1";
  }
}

void Child::Signal(int signal) const {
  if (!ended_) kill(-pid_, signal);
}

std::optional<ProcessEnd> Child::TakeEnd() {
  siginfo_t info{};
  const int got = waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
  if (got != 0 || info.si_pid == 0) return std::nullopt;
  // As long as it is not reaped, no other process can have its number.
  kill(-pid_, SIGKILL);
  int status = 0;
  rusage usage{};
  wait4(pid_, &status, 0, &usage);
  ended_ = true;
  constexpr std::int64_t kUnit_bytes = 1024;
  return ProcessEnd{.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
                    .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                    .peak_memory_bytes = kUnit_bytes * usage.ru_maxrss};
}

std::filesystem::path FindExecutable(const std::string& name) {
  std::error_code none;
  const auto executable = [&](const std::filesystem::path& file) {
    return std::filesystem::is_regular_file(file, none) && access(file.c_str(), X_OK) == 0;
  };
  if (name.find('/') != std::string::npos) {
    return executable(name) ? std::filesystem::absolute(name) : std::filesystem::path();
  }
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (executable(std::filesystem::path(folder) / name)) {
      return std::filesystem::path(folder) / name;
    }
  }
  return {};
}

}  // namespace palpate::command
