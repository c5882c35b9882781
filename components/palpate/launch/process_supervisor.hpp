// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "components/palpate/system/system_file.hpp"

namespace palpate::command {

/// How a process ended.
struct ProcessEnd {
  int exit_code = 0;  ///< where `signal` is 0
  int signal = 0;     ///< that ended it; 0: none
  std::int64_t peak_memory_bytes = 0;
};

/// "exit code 1", or "signal 11 (Segmentation fault)".
std::string Describe(const ProcessEnd& end);

enum class LaunchState {
  kWaiting,     ///< for its predecessors
  kBackingOff,  ///< until it may start, the first time at once
  kStarting,
  kReady,
  kStopping,
  kFinished,  ///< ended by itself with 0, final
  kStopped,   ///< on request, final
  kFailed,    ///< final
};
std::string ToString(LaunchState state);

/// The life of one process: start, readiness, restarts, stop. It starts nothing itself: whoever
/// runs the process reports what happens and does what Next() says. Times are of one clock that
/// never goes back, s.
class ProcessSupervisor {
 public:
  struct Rules {
    bool notifies = true;
    double ready_timeout_s = 60.0;
    std::optional<RespawnPlan> respawn;
    StopPlan stop;
    bool exit_2_is_final = false;  ///< wrong usage or settings: a restart cannot help
  };
  enum class Action { kNone, kStart, kInterrupt, kTerminate, kKill };

  explicit ProcessSupervisor(const Rules& rules) : rules_(rules) {}

  /// What is to be done now; to be called until it is kNone.
  Action Next(double now_s);
  /// When Next() is to be called again at the latest; nullopt: whenever something happens.
  std::optional<double> Deadline_s() const;

  // What happened, or is wanted.
  void Allow(double now_s);                 ///< its predecessors are ready
  void Abandon(const std::string& reason);  ///< they failed
  void Started(double now_s);
  void StartFailed(double now_s, const std::string& reason);
  void Ready(double now_s);
  void Ended(double now_s, const ProcessEnd& end);
  void Stop(double now_s);
  void Hurry(double now_s);  ///< the next signal at once

  LaunchState state() const { return state_; }
  bool IsFinal() const;
  bool IsRunning() const;
  /// Whether a stop was asked for.
  bool WasStopped() const { return stop_asked_; }
  /// Of the last state change, for people: "exit code 1; restart 2 of 5 in 4 s".
  const std::string& reason() const { return reason_; }
  int restarts() const { return restarts_; }
  /// Of all runs together, until now.
  double RunTime_s(double now_s) const;
  /// The largest of all runs; 0: none has ended.
  std::int64_t peak_memory_bytes() const { return peak_memory_bytes_; }
  const std::optional<ProcessEnd>& last_end() const { return last_end_; }
  /// From the last start until it was ready.
  double ready_after_s() const { return ready_after_s_; }
  /// Whether it failed for good, or had to be killed, or ended with an error when it was stopped.
  bool HasFailed() const;

 private:
  void Change(LaunchState state, const std::string& reason);
  void Fail(double now_s, const std::string& reason);
  Action NextSignal(double now_s);

  Rules rules_;
  LaunchState state_ = LaunchState::kWaiting;
  std::string reason_;
  double start_at_s_ = 0.0;  // kBackingOff
  double started_s_ = 0.0;
  double ready_s_ = 0.0;
  double ready_after_s_ = 0.0;
  double next_signal_s_ = 0.0;  // kStopping
  int signals_sent_ = 0;
  bool stop_asked_ = false;
  bool too_late_ = false;  // stopped because it was not ready in time
  int in_a_row_ = 0;
  int restarts_ = 0;
  double earlier_runs_s_ = 0.0;
  std::int64_t peak_memory_bytes_ = 0;
  std::optional<ProcessEnd> last_end_;
};

}  // namespace palpate::command
