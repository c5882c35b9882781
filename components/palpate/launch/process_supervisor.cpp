// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/process_supervisor.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>

#include "libs/core/check.hpp"

namespace palpate::command {

namespace {

constexpr int kWrongUsage = 2;
constexpr int kStopSignals = 3;  // SIGINT, SIGTERM, SIGKILL

/// Whether a process that was asked to stop ended as it should: with 0, or by that signal, as
/// programs without a handler do (shells say 128 + signal).
bool StoppedWell(const ProcessEnd& end) {
  if (end.signal != 0) return end.signal == SIGINT || end.signal == SIGTERM;
  return end.exit_code == 0 || end.exit_code == 128 + SIGINT || end.exit_code == 128 + SIGTERM;
}

}  // namespace

std::string Describe(const ProcessEnd& end) {
  if (end.signal == 0) return fmt::format("exit code {}", end.exit_code);
  return fmt::format("signal {} ({})", end.signal, strsignal(end.signal));
}

std::string ToString(LaunchState state) {
  switch (state) {
    case LaunchState::kWaiting: return "waiting";
    case LaunchState::kBackingOff: return "backing off";
    case LaunchState::kStarting: return "starting";
    case LaunchState::kReady: return "ready";
    case LaunchState::kStopping: return "stopping";
    case LaunchState::kFinished: return "finished";
    case LaunchState::kStopped: return "stopped";
    case LaunchState::kFailed: return "failed";
  }
  return {};
}

bool ProcessSupervisor::IsFinal() const {
  return state_ == LaunchState::kFinished || state_ == LaunchState::kStopped ||
         state_ == LaunchState::kFailed;
}

bool ProcessSupervisor::IsRunning() const {
  return state_ == LaunchState::kStarting || state_ == LaunchState::kReady ||
         state_ == LaunchState::kStopping;
}

bool ProcessSupervisor::HasFailed() const {
  if (state_ == LaunchState::kFailed) return true;
  return state_ == LaunchState::kStopped && last_end_ && !StoppedWell(*last_end_);
}

double ProcessSupervisor::RunTime_s(double now_s) const {
  return earlier_runs_s_ + (IsRunning() ? now_s - started_s_ : 0.0);
}

std::optional<double> ProcessSupervisor::Deadline_s() const {
  switch (state_) {
    case LaunchState::kBackingOff: return start_at_s_;
    case LaunchState::kStarting: return started_s_ + rules_.ready_timeout_s;
    case LaunchState::kStopping:
      if (signals_sent_ < kStopSignals) return next_signal_s_;
      return std::nullopt;
    default: return std::nullopt;
  }
}

ProcessSupervisor::Action ProcessSupervisor::Next(double now_s) {
  if (state_ == LaunchState::kBackingOff && now_s >= start_at_s_) return Action::kStart;
  if (state_ == LaunchState::kStarting && now_s >= started_s_ + rules_.ready_timeout_s) {
    too_late_ = true;
    signals_sent_ = 0;
    next_signal_s_ = now_s;
    Change(LaunchState::kStopping, fmt::format("not ready within {:g} s", rules_.ready_timeout_s));
  }
  return state_ == LaunchState::kStopping ? NextSignal(now_s) : Action::kNone;
}

ProcessSupervisor::Action ProcessSupervisor::NextSignal(double now_s) {
  if (signals_sent_ == kStopSignals || now_s < next_signal_s_) return Action::kNone;
  ++signals_sent_;
  if (signals_sent_ == 1) {
    next_signal_s_ = now_s + rules_.stop.interrupt_s;
    return Action::kInterrupt;
  }
  next_signal_s_ = now_s + rules_.stop.terminate_s;
  return signals_sent_ == 2 ? Action::kTerminate : Action::kKill;
}

void ProcessSupervisor::Allow(double now_s) {
  if (state_ != LaunchState::kWaiting) return;
  start_at_s_ = now_s;
  Change(LaunchState::kBackingOff, "");
}

void ProcessSupervisor::Abandon(const std::string& reason) {
  if (state_ == LaunchState::kWaiting) Change(LaunchState::kFailed, reason);
}

void ProcessSupervisor::Started(double now_s) {
  PALPATE_CHECK(state_ == LaunchState::kBackingOff, ToString(state_));
  started_s_ = now_s;
  too_late_ = false;
  Change(LaunchState::kStarting, "");
  if (!rules_.notifies) Ready(now_s);
}

void ProcessSupervisor::StartFailed(double now_s, const std::string& reason) {
  PALPATE_CHECK(state_ == LaunchState::kBackingOff, ToString(state_));
  Fail(now_s, reason);
}

void ProcessSupervisor::Ready(double now_s) {
  if (state_ != LaunchState::kStarting) return;
  ready_s_ = now_s;
  ready_after_s_ = now_s - started_s_;
  Change(LaunchState::kReady, fmt::format("ready after {:.1f} s", ready_after_s_));
}

void ProcessSupervisor::Ended(double now_s, const ProcessEnd& end) {
  PALPATE_CHECK(IsRunning(), ToString(state_));
  const double ran_s = now_s - started_s_;
  earlier_runs_s_ += ran_s;
  last_end_ = end;
  peak_memory_bytes_ = std::max(peak_memory_bytes_, end.peak_memory_bytes);
  if (state_ == LaunchState::kReady && rules_.respawn &&
      now_s - ready_s_ >= rules_.respawn->reset_after_s) {
    in_a_row_ = 0;
  }
  const std::string what = fmt::format("{} after {:.1f} s", Describe(end), ran_s);
  if (stop_asked_) return Change(LaunchState::kStopped, what);
  if (too_late_) return Fail(now_s, "not ready in time: " + what);
  const bool ended_well = end.signal == 0 && end.exit_code == 0;
  if (ended_well && !(rules_.respawn && rules_.respawn->always)) {
    return Change(LaunchState::kFinished, what);
  }
  if (rules_.exit_2_is_final && end.signal == 0 && end.exit_code == kWrongUsage) {
    return Change(LaunchState::kFailed, what + ": wrong usage or settings, not started again");
  }
  Fail(now_s, what);
}

void ProcessSupervisor::Fail(double now_s, const std::string& reason) {
  if (!rules_.respawn) return Change(LaunchState::kFailed, reason);
  const RespawnPlan& respawn = *rules_.respawn;
  if (in_a_row_ >= respawn.limit) {
    return Change(LaunchState::kFailed,
                  fmt::format("{}; not started again after {} restarts", reason, in_a_row_));
  }
  const double wait_s =
      std::min(respawn.longest_backoff_s, std::ldexp(respawn.backoff_s, in_a_row_));
  ++in_a_row_;
  ++restarts_;
  start_at_s_ = now_s + wait_s;
  Change(LaunchState::kBackingOff,
         fmt::format("{}; restart {} of {} in {:g} s", reason, in_a_row_, respawn.limit, wait_s));
}

void ProcessSupervisor::Stop(double now_s) {
  if (stop_asked_ || IsFinal()) return;
  stop_asked_ = true;
  if (!IsRunning()) return Change(LaunchState::kStopped, "not running");
  if (state_ == LaunchState::kStopping) return;  // the signals of a late one go on
  signals_sent_ = 0;
  next_signal_s_ = now_s;
  Change(LaunchState::kStopping, "");
}

void ProcessSupervisor::Hurry(double now_s) {
  if (state_ == LaunchState::kStopping) next_signal_s_ = now_s;
}

void ProcessSupervisor::Change(LaunchState state, const std::string& reason) {
  state_ = state;
  reason_ = reason;
}

}  // namespace palpate::command
