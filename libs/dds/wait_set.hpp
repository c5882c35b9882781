// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "libs/dds/endpoint.hpp"
#include "libs/dds/participant.hpp"

namespace palpate::dds {

/// A call that is made once, at the time set last. Made by WaitSet::AddAlarm; to be set by the
/// loop's thread.
class Alarm {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Alarm(std::function<void()> on_time) : on_time_(std::move(on_time)) {}

  void Set(Time when) { when_ = when; }
  void Clear() { when_ = Time::max(); }

 private:
  friend class WaitSet;

  Time when_ = Time::max();
  std::function<void()> on_time_;
};

/// The loop of a node: waits without turning for messages, timers and Wake(), and calls who asked.
/// All calls come from the thread that is inside Run() or DispatchUntil(), one at a time.
class WaitSet {
 public:
  using Clock = std::chrono::steady_clock;

  /// Answers questions about the participant's parameters, too. Throws RunError where DDS refuses.
  explicit WaitSet(const Participant& participant);

  /// Calls `on_data` while messages wait in `reader`; it must take them. The reader must outlive
  /// this. Throws RunError where DDS refuses.
  void Attach(const Endpoint& reader, std::function<void()> on_data) {
    Attach(reader.handle(), std::move(on_data));
  }
  void Attach(dds_entity_t reader, std::function<void()> on_data);
  /// Calls `on_time` every `period`, first after one period; missed turns are left out.
  void Every(Clock::duration period, std::function<void()> on_time);

  /// For what is due at a time that changes: calls `on_time` once the time set in the alarm has
  /// come. Stays valid as long as this.
  Alarm& AddAlarm(std::function<void()> on_time);

  /// Calls `on_wake` after every Wake().
  void OnWake(std::function<void()> on_wake) { on_wake_ = std::move(on_wake); }

  /// Dispatches until Stop().
  void Run();
  /// Dispatches until `done()` holds, then true; false once `deadline` is reached or after Stop().
  /// `done` is asked after every event and Wake().
  bool DispatchUntil(const std::function<bool()>& done, Clock::time_point deadline);

  /// Both are safe from any thread, not from a signal handler.
  void Stop();
  void Wake();
  bool stopped() const { return stopped_; }

 private:
  struct Source {
    Entity condition;
    std::function<void()> on_data;
  };
  struct Timer {
    Clock::duration period;
    Clock::time_point next;
    std::function<void()> on_time;
  };

  void WaitForEvent(Clock::time_point deadline);
  void CallTimers();
  void CallAlarms();
  Clock::time_point Earliest(Clock::time_point deadline) const;

  Entity guard_;
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<Timer> timers_;
  std::vector<std::unique_ptr<Alarm>> alarms_;
  std::function<void()> on_wake_;
  Entity wait_set_;  // goes first: it refers to the conditions above
  std::atomic<bool> stopped_ = false;
};

}  // namespace palpate::dds
