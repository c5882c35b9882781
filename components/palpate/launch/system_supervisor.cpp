// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/launch/system_supervisor.hpp"

#include <algorithm>
#include <csignal>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/names.hpp"

namespace palpate::command {

namespace {

bool IsThere(const ProcessSupervisor& process) {
  return process.state() == LaunchState::kReady || process.state() == LaunchState::kFinished;
}

}  // namespace

SystemSupervisor::SystemSupervisor(std::vector<SupervisedProcess> processes, ProcessHands* hands)
    : processes_(std::move(processes)),
      after_(processes_.size()),
      before_(processes_.size()),
      held_(processes_.size(), false),
      reported_(processes_.size(), LaunchState::kWaiting),
      hands_(hands) {
  std::vector<std::string> names;
  for (const SupervisedProcess& process : processes_) {
    names.push_back(process.name);
    supervisors_.emplace_back(process.rules);
  }
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    for (const std::string& name : processes_[i].after) {
      const auto index = IndexOf(name, names);
      PALPATE_CHECK(index.has_value(), name);
      after_[i].push_back(*index);
      before_[*index].push_back(i);
    }
  }
}

void SystemSupervisor::Step(double now_s) {
  CheckRequired();
  if (stopping_) {
    StopDue(now_s);
  } else {
    StartDue(now_s);
  }
  for (std::size_t i = 0; i < size(); ++i) Act(i, now_s);
  Report();
}

void SystemSupervisor::StartDue(double now_s) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (supervisors_[i].state() != LaunchState::kWaiting || held_[i]) continue;
    bool all_there = true;
    for (const std::size_t earlier : after_[i]) {
      const ProcessSupervisor& process = supervisors_[earlier];
      all_there = all_there && IsThere(process);
      if (process.state() == LaunchState::kFailed) {
        supervisors_[i].Abandon("not started, because " + processes_[earlier].name + " failed");
      }
    }
    if (all_there) supervisors_[i].Allow(now_s);
  }
}

void SystemSupervisor::StopDue(double now_s) {
  for (std::size_t i = 0; i < size(); ++i) {
    const bool is_free = std::all_of(before_[i].begin(), before_[i].end(), [&](std::size_t later) {
      return !supervisors_[later].IsRunning();
    });
    if (is_free || !supervisors_[i].IsRunning()) supervisors_[i].Stop(now_s);
  }
}

void SystemSupervisor::CheckRequired() {
  for (std::size_t i = 0; i < size() && !stopping_; ++i) {
    if (!processes_[i].required || !supervisors_[i].IsFinal()) continue;
    RequestStop("the required process " + processes_[i].name + " " +
                ToString(supervisors_[i].state()));
  }
}

void SystemSupervisor::Act(std::size_t index, double now_s) {
  using Action = ProcessSupervisor::Action;
  ProcessSupervisor& process = supervisors_[index];
  for (Action action; (action = process.Next(now_s)) != Action::kNone;) {
    if (action != Action::kStart) {
      hands_->Signal(index, action == Action::kInterrupt   ? SIGINT
                            : action == Action::kTerminate ? SIGTERM
                                                           : SIGKILL);
      continue;
    }
    const std::string reason = hands_->Start(index);
    if (reason.empty()) {
      process.Started(now_s);
    } else {
      process.StartFailed(now_s, reason);
    }
  }
}

void SystemSupervisor::Report() {
  for (std::size_t i = 0; i < size(); ++i) {
    if (reported_[i] == supervisors_[i].state()) continue;
    reported_[i] = supervisors_[i].state();
    hands_->Changed(i, supervisors_[i]);
  }
}

std::optional<double> SystemSupervisor::Deadline_s() const {
  std::optional<double> earliest_s;
  for (const ProcessSupervisor& process : supervisors_) {
    const std::optional<double> deadline_s = process.Deadline_s();
    if (deadline_s && (!earliest_s || *deadline_s < *earliest_s)) earliest_s = deadline_s;
  }
  return earliest_s;
}

void SystemSupervisor::Ready(std::size_t index, double now_s) {
  supervisors_[index].Ready(now_s);
  Report();
}

void SystemSupervisor::Ended(std::size_t index, double now_s, const ProcessEnd& end) {
  supervisors_[index].Ended(now_s, end);
  Report();
}

void SystemSupervisor::RequestStop(const std::string& reason) {
  if (stopping_) return;
  stopping_ = true;
  hands_->Stopping(reason);
}

void SystemSupervisor::Hurry(double now_s) {
  for (ProcessSupervisor& process : supervisors_) {
    process.Stop(now_s);
    process.Hurry(now_s);
  }
}

bool SystemSupervisor::AllEnded() const {
  return std::all_of(supervisors_.begin(), supervisors_.end(),
                     [](const ProcessSupervisor& process) { return process.IsFinal(); });
}

bool SystemSupervisor::AllReady() const {
  return std::all_of(supervisors_.begin(), supervisors_.end(), IsThere);
}

bool SystemSupervisor::RequiredFailed() const {
  for (std::size_t i = 0; i < size(); ++i) {
    if (processes_[i].required && supervisors_[i].HasFailed()) return true;
  }
  return false;
}

}  // namespace palpate::command
