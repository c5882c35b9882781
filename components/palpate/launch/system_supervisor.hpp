// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/launch/process_supervisor.hpp"

namespace palpate::command {

/// One process among others.
struct SupervisedProcess {
  std::string name;
  std::vector<std::string> after;  ///< names of others, without a circle
  bool required = false;
  ProcessSupervisor::Rules rules;
};

/// Who really starts and signals processes; they are named by their index. Tests stand in for it.
class ProcessHands {
 public:
  ProcessHands() = default;
  virtual ~ProcessHands() = default;
  ProcessHands(const ProcessHands&) = delete;
  ProcessHands& operator=(const ProcessHands&) = delete;

  /// Empty: started; else the reason why not.
  virtual std::string Start(std::size_t index) = 0;
  virtual void Signal(std::size_t index, int signal) = 0;
  /// The state of a process has changed.
  virtual void Changed(std::size_t index, const ProcessSupervisor& process) = 0;
  /// All are being stopped.
  virtual void Stopping(const std::string& reason) = 0;
};

/// The processes of one host together: the order of start and stop, and required processes.
class SystemSupervisor {
 public:
  /// `hands` must outlive this object.
  SystemSupervisor(std::vector<SupervisedProcess> processes, ProcessHands* hands);

  /// Does all that is due at `now_s`.
  void Step(double now_s);
  /// When Step() is to be called again at the latest.
  std::optional<double> Deadline_s() const;

  void Ready(std::size_t index, double now_s);
  void Ended(std::size_t index, double now_s, const ProcessEnd& end);
  /// All end, each after those that named it in `after`.
  void RequestStop(const std::string& reason);
  /// After RequestStop(): all get their next signal now, in no order.
  void Hurry(double now_s);
  /// A held process does not start before Release().
  void Hold(std::size_t index) { held_[index] = true; }
  void Release(std::size_t index) { held_[index] = false; }

  bool IsStopping() const { return stopping_; }
  bool AllEnded() const;
  /// Whether each is ready, or has finished.
  bool AllReady() const;
  /// Whether a required process has failed.
  bool RequiredFailed() const;
  std::size_t size() const { return processes_.size(); }
  const ProcessSupervisor& process(std::size_t index) const { return supervisors_[index]; }
  const SupervisedProcess& rules(std::size_t index) const { return processes_[index]; }

 private:
  void StartDue(double now_s);
  void StopDue(double now_s);
  void CheckRequired();
  void Act(std::size_t index, double now_s);
  void Report();

  std::vector<SupervisedProcess> processes_;
  std::vector<ProcessSupervisor> supervisors_;
  std::vector<std::vector<std::size_t>> after_;   // by index
  std::vector<std::vector<std::size_t>> before_;  // the other way round
  std::vector<bool> held_;
  std::vector<LaunchState> reported_;
  bool stopping_ = false;
  ProcessHands* hands_;
};

}  // namespace palpate::command
