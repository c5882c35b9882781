// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "libs/core/parameter.hpp"

namespace palpate::dds {

/// How the data that a process sends are made faulty on command.
enum class FaultKind {
  kNone,
  kOff,      ///< nothing is sent
  kStuck,    ///< the data of the first message under the fault, with new stamps and counters
  kSlow,     ///< each message later by delay_s
  kGarbage,  ///< random numbers, finite or not, and random pixels
  kWrong,    ///< plausible, but not true (Falsify)
};

/// "none", "off", "stuck", "slow", "garbage", "wrong".
const std::vector<std::string>& FaultWords();
std::string_view ToString(FaultKind kind);

/// Names of the parameters of a node by which it takes commands.
inline constexpr char kFaultParameter[] = "fault";
inline constexpr char kFaultDelayParameter[] = "fault_delay_s";

/// The fault that a process has on command, for all writers of data that it has. What `slow` holds
/// back is sent by a thread of its own, which runs from the first such message on. Safe from any
/// thread.
class CommandedFault {
 public:
  using Clock = std::chrono::steady_clock;
  using Log = std::function<void(const std::string&)>;

  /// `log`: takes one line when a fault begins, and one when it ends.
  explicit CommandedFault(Log log) : log_(std::move(log)) {}
  ~CommandedFault();
  CommandedFault(const CommandedFault&) = delete;
  CommandedFault& operator=(const CommandedFault&) = delete;

  FaultKind kind() const { return kind_; }
  double delay_s() const { return delay_s_; }
  /// Rises with each change: what a writer kept for an earlier fault is void.
  std::uint64_t changes() const { return changes_; }

  /// A writer of data that follows this. `can_be_wrong`: its messages have a wrong form.
  void AddWriter(bool can_be_wrong);

  /// Return "", or the reason of a refusal. What is held back is sent before the change holds.
  std::string Set(const ParameterValue& value);
  std::string SetDelay(const ParameterValue& value);

  /// Holds back what `send` sends. False where as much waits already as may; where the fault has
  /// just ended, it is sent at once.
  bool SendLater(std::size_t bytes, std::function<void()> send);

 private:
  struct Held {
    Clock::time_point due;
    std::size_t bytes;
    std::function<void()> send;
  };

  std::string RefusalOf(FaultKind kind) const;
  void SendHeld();

  Log log_;
  std::atomic<FaultKind> kind_{FaultKind::kNone};
  std::atomic<double> delay_s_{0.5};
  std::atomic<std::uint64_t> changes_{0};
  std::atomic<bool> has_writers_{false};
  std::atomic<bool> can_be_wrong_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Held> held_;  ///< in the order of their times
  std::size_t held_bytes_ = 0;
  bool stopped_ = false;
  std::thread sender_;
};

/// The parameters that command it. nullptr: they are shown, and refused.
std::vector<Parameter> FaultParameters(CommandedFault* fault);

}  // namespace palpate::dds
