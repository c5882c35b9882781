// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/launcher.hpp"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"

namespace palpate::command {

namespace {

// An end is seen when the pipe closes; of a process whose pipe another one holds, after this time.
constexpr double kLongestWait_s = 0.1;
constexpr std::size_t kLongestLine = 65536;

std::vector<SupervisedProcess> ProcessesOf(const std::vector<LaunchedProcess>& all) {
  std::vector<SupervisedProcess> processes;
  for (const LaunchedProcess& one : all) processes.push_back(one.process);
  return processes;
}

std::vector<ChildCommand> CommandsOf(const std::vector<LaunchedProcess>& all) {
  std::vector<ChildCommand> commands;
  for (const LaunchedProcess& one : all) commands.push_back(one.command);
  return commands;
}

Severity SeverityOf(const ProcessSupervisor& process) {
  if (process.HasFailed()) return Severity::kError;
  const bool restarts =
      process.state() == LaunchState::kBackingOff && process.last_end().has_value();
  const bool too_late = process.state() == LaunchState::kStopping && !process.WasStopped();
  return restarts || too_late ? Severity::kWarning : Severity::kInfo;
}

}  // namespace

Launcher::Launcher(const std::vector<LaunchedProcess>& processes, const StopPlan& stop,
                   LaunchOutput* output)
    : commands_(CommandsOf(processes)),
      output_(output),
      guardian_(stop),
      children_(processes.size()),
      unfinished_lines_(processes.size()),
      supervisor_(ProcessesOf(processes), this) {}

Launcher::~Launcher() { StopAll("the launcher ends"); }

double Launcher::Now_s() const { return NsToSeconds(MonotonicNow_ns()); }

std::size_t Launcher::IndexOfProcess(const std::string& name) const {
  for (std::size_t i = 0; i < supervisor_.size(); ++i) {
    if (supervisor_.rules(i).name == name) return i;
  }
  PALPATE_CHECK(false, name, "is no process");
  return 0;
}

bool Launcher::Turn(double wait_s, int wake_fd) {
  supervisor_.Step(Now_s());
  if (supervisor_.AllEnded()) return false;
  double until_due_s = std::min(wait_s, kLongestWait_s);
  if (const auto deadline_s = supervisor_.Deadline_s()) {
    until_due_s = std::clamp(*deadline_s - Now_s(), 0.0, until_due_s);
  }
  Wait(until_due_s, wake_fd);
  Collect();
  return !supervisor_.AllEnded();
}

void Launcher::StopAll(const std::string& reason) {
  if (supervisor_.AllEnded()) return;
  supervisor_.RequestStop(reason);
  while (Turn(kLongestWait_s)) {
  }
}

void Launcher::Hurry() {
  supervisor_.Hurry(Now_s());
  supervisor_.Step(Now_s());
}

void Launcher::Wait(double wait_s, int wake_fd) {
  std::vector<pollfd> descriptors;
  for (const auto& child : children_) {
    if (!child) continue;
    descriptors.push_back({.fd = child->output(), .events = POLLIN, .revents = 0});
    descriptors.push_back({.fd = child->notify(), .events = POLLIN, .revents = 0});
  }
  if (wake_fd >= 0) descriptors.push_back({.fd = wake_fd, .events = POLLIN, .revents = 0});
  constexpr double kPerSecond_ms = 1000.0;
  poll(descriptors.data(), descriptors.size(), static_cast<int>(std::ceil(wait_s * kPerSecond_ms)));
}

void Launcher::Collect() {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    if (!children_[i]) continue;
    if (children_[i]->ReadReady()) supervisor_.Ready(i, Now_s());
    // First the end: what was written before it is then in the pipe.
    const std::optional<ProcessEnd> end = children_[i]->TakeEnd();
    TakeOutput(i);
    if (!end) continue;
    PassLines(i, true);
    guardian_.Forget(children_[i]->pid());
    children_[i].reset();
    supervisor_.Ended(i, Now_s(), *end);
  }
}

void Launcher::TakeOutput(std::size_t index) {
  for (;;) {
    const std::optional<std::string> text = children_[index]->ReadOutput();
    if (!text || text->empty()) return;
    unfinished_lines_[index] += *text;
    PassLines(index, false);
  }
}

void Launcher::PassLines(std::size_t index, bool with_the_last) {
  std::string& text = unfinished_lines_[index];
  const std::string& name = supervisor_.rules(index).name;
  std::size_t from = 0;
  for (std::size_t end = 0; (end = text.find('\n', from)) != std::string::npos; from = end + 1) {
    output_->Line(name, std::string_view(text).substr(from, end - from));
  }
  text.erase(0, from);
  if ((with_the_last && !text.empty()) || text.size() > kLongestLine) {
    output_->Line(name, text);
    text.clear();
  }
}

std::string Launcher::Start(std::size_t index) {
  try {
    children_[index] = std::make_unique<Child>(commands_[index], started_++);
  } catch (const RunError& error) {
    return error.what();
  }
  const pid_t pid = children_[index]->pid();
  guardian_.Watch(pid);
  output_->Event(supervisor_.rules(index).name, Severity::kInfo,
                 fmt::format("started (process {})", pid));
  return {};
}

void Launcher::Signal(std::size_t index, int signal) {
  PALPATE_CHECK(children_[index] != nullptr, index);
  if (signal != SIGINT) {
    output_->Event(supervisor_.rules(index).name, Severity::kWarning,
                   fmt::format("still runs: {}", signal == SIGTERM ? "SIGTERM" : "SIGKILL"));
  }
  children_[index]->Signal(signal);
}

void Launcher::Changed(std::size_t index, const ProcessSupervisor& process) {
  const std::string& name = supervisor_.rules(index).name;
  if (process.reason().empty()) return;
  const bool is_final = process.IsFinal();
  output_->Event(name, SeverityOf(process),
                 is_final ? ToString(process.state()) + ": " + process.reason() : process.reason());
}

void Launcher::Stopping(const std::string& reason) {
  output_->Event({}, Severity::kInfo, "stopping all processes: " + reason);
}

std::vector<ProcessReport> Launcher::Reports() const {
  std::vector<ProcessReport> reports;
  for (std::size_t i = 0; i < supervisor_.size(); ++i) {
    const ProcessSupervisor& process = supervisor_.process(i);
    reports.push_back({.name = supervisor_.rules(i).name,
                       .required = supervisor_.rules(i).required,
                       .failed = process.HasFailed(),
                       .state = process.state(),
                       .last_end = process.last_end(),
                       .reason = process.reason(),
                       .restarts = process.restarts(),
                       .run_time_s = process.RunTime_s(Now_s()),
                       .peak_memory_bytes = process.peak_memory_bytes()});
  }
  return reports;
}

}  // namespace palpate::command
