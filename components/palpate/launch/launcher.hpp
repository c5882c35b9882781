// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/palpate/launch/child.hpp"
#include "components/palpate/launch/guardian.hpp"
#include "components/palpate/launch/system_supervisor.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/severity.hpp"

namespace palpate::command {

/// One process of a system, ready to be started.
struct LaunchedProcess {
  SupervisedProcess process;
  ChildCommand command;
};

/// Takes what the processes write and what becomes of them.
class LaunchOutput {
 public:
  LaunchOutput() = default;
  virtual ~LaunchOutput() = default;
  LaunchOutput(const LaunchOutput&) = delete;
  LaunchOutput& operator=(const LaunchOutput&) = delete;

  /// One line, without its end.
  virtual void Line(const std::string& process, std::string_view line) = 0;
  /// `process`: empty: all of them.
  virtual void Event(const std::string& process, Severity severity, const std::string& text) = 0;
};

/// What became of one process.
struct ProcessReport {
  std::string name;
  bool required = false;
  bool failed = false;
  LaunchState state = LaunchState::kWaiting;
  std::optional<ProcessEnd> last_end;  ///< nullopt: it never ended, or never began
  std::string reason;
  int restarts = 0;
  double run_time_s = 0.0;
  std::int64_t peak_memory_bytes = 0;
};

/// Starts the processes of one host, keeps them running and ends them. None of them outlives this
/// process, however it ends. To be used by one thread.
class Launcher : private ProcessHands {
 public:
  /// `output` must outlive this object. Throws RunError where the system has no process left.
  Launcher(const std::vector<LaunchedProcess>& processes, const StopPlan& stop,
           LaunchOutput* output);
  /// StopAll().
  ~Launcher() override;

  /// Does what is due, and waits for up to `wait_s` until something happens, also on `wake_fd` (-1:
  /// none). False: all have ended.
  bool Turn(double wait_s, int wake_fd = -1);
  /// Stops all and waits for their end, as long as the stop plan has it.
  void StopAll(const std::string& reason);

  void RequestStop(const std::string& reason) { supervisor_.RequestStop(reason); }
  void Hurry();
  void Hold(const std::string& name) { supervisor_.Hold(IndexOfProcess(name)); }
  void Release(const std::string& name) { supervisor_.Release(IndexOfProcess(name)); }

  bool AllReady() const { return supervisor_.AllReady(); }
  bool IsStopping() const { return supervisor_.IsStopping(); }
  bool RequiredFailed() const { return supervisor_.RequiredFailed(); }
  std::vector<ProcessReport> Reports() const;

 private:
  std::string Start(std::size_t index) override;
  void Signal(std::size_t index, int signal) override;
  void Changed(std::size_t index, const ProcessSupervisor& process) override;
  void Stopping(const std::string& reason) override;

  double Now_s() const;
  std::size_t IndexOfProcess(const std::string& name) const;
  void Wait(double wait_s, int wake_fd);
  void TakeOutput(std::size_t index);
  void Collect();
  void PassLines(std::size_t index, bool with_the_last);

  std::vector<ChildCommand> commands_;
  LaunchOutput* output_;
  Guardian guardian_;
  std::vector<std::unique_ptr<Child>> children_;  // nullptr: does not run
  std::vector<std::string> unfinished_lines_;
  int started_ = 0;
  SystemSupervisor supervisor_;
};

}  // namespace palpate::command
