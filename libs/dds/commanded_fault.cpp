// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/commanded_fault.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/core/names.hpp"
#include "libs/core/number_rule.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::dds {

namespace {

/// Of what is held back: 10 s of a camera with 1280 x 720 pixels at 5 Hz, or 2 s at 30 Hz.
constexpr std::size_t kMostHeldBytes = std::size_t{256} << 20;
constexpr double kLeastDelay_s = 0.001;
constexpr double kMostDelay_s = 10.0;
constexpr const char* kNotAllowed =
    "faults on command are not allowed: set dds.allow_faults to true, or allow_faults: true in the "
    "system file, and start again";

std::optional<double> AsNumber(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

}  // namespace

const std::vector<std::string>& FaultWords() {
  static const std::vector<std::string> words{"none", "off", "stuck", "slow", "garbage", "wrong"};
  return words;
}

std::string_view ToString(FaultKind kind) { return FaultWords()[static_cast<std::size_t>(kind)]; }

CommandedFault::~CommandedFault() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  if (sender_.joinable()) sender_.join();
}

void CommandedFault::AddWriter(bool can_be_wrong) {
  has_writers_ = true;
  if (can_be_wrong) can_be_wrong_ = true;
}

std::string CommandedFault::RefusalOf(FaultKind kind) const {
  if (kind == FaultKind::kNone) return "";
  if (!has_writers_) return "this process writes no data that could be faulty";
  if (kind == FaultKind::kWrong && !can_be_wrong_) {
    return "the data of this process have no wrong form: take garbage";
  }
  return "";
}

std::string CommandedFault::Set(const ParameterValue& value) {
  const auto* word = std::get_if<std::string>(&value);
  const auto index = word == nullptr ? std::nullopt : IndexOf(*word, FaultWords());
  if (!index) {
    return "must be one of " + Listed(FaultWords()) +
           (word == nullptr ? "" : ", not '" + *word + "'" + DidYouMean(*word, FaultWords()));
  }
  const auto kind = static_cast<FaultKind>(*index);
  if (std::string refusal = RefusalOf(kind); !refusal.empty()) return refusal;
  FaultKind before{};
  {
    const std::lock_guard lock(mutex_);
    for (Held& held : held_) held.send();
    held_.clear();
    held_bytes_ = 0;
    before = kind_.exchange(kind);
    ++changes_;
  }
  if (before == kind) return "";
  if (before != FaultKind::kNone) {
    log_("fault on command ends: " + std::string(ToString(before)));
  }
  if (kind != FaultKind::kNone) {
    log_("fault on command: " + *word +
         (kind == FaultKind::kSlow ? " (" + FormatNumber(delay_s_) + " s)" : std::string()));
  }
  return "";
}

std::string CommandedFault::SetDelay(const ParameterValue& value) {
  const auto delay_s = AsNumber(value);
  if (!delay_s || !(*delay_s >= kLeastDelay_s && *delay_s <= kMostDelay_s)) {
    return "must be a number of " + FormatNumber(kLeastDelay_s) + " to " +
           FormatNumber(kMostDelay_s) + " s";
  }
  delay_s_ = *delay_s;
  return "";
}

bool CommandedFault::SendLater(std::size_t bytes, std::function<void()> send) {
  const Clock::time_point due = Clock::now() + FromSeconds(delay_s_);
  {
    const std::lock_guard lock(mutex_);
    if (kind_ != FaultKind::kSlow) {
      send();
      return true;
    }
    if (held_bytes_ + bytes > kMostHeldBytes) return false;
    // A delay that was made shorter must not turn the order around.
    const Clock::time_point in_order = held_.empty() ? due : std::max(due, held_.back().due);
    held_.push_back({in_order, bytes, std::move(send)});
    held_bytes_ += bytes;
    if (!sender_.joinable()) sender_ = std::thread([this] { SendHeld(); });
  }
  changed_.notify_all();
  return true;
}

void CommandedFault::SendHeld() {
  std::unique_lock lock(mutex_);
  while (!stopped_) {
    if (held_.empty()) {
      changed_.wait(lock);
    } else if (Clock::now() < held_.front().due) {
      changed_.wait_until(lock, Clock::time_point(held_.front().due));
    } else {
      // Sent under the lock, so that Set() cannot send a later one before it.
      held_.front().send();
      held_bytes_ -= held_.front().bytes;
      held_.pop_front();
    }
  }
}

std::vector<Parameter> FaultParameters(CommandedFault* fault) {
  Parameter kind{kFaultParameter, FaultWords().front()};
  kind.description = "Makes all data that this process sends faulty, for tests of a system";
  kind.constraints = Listed(FaultWords());
  Parameter delay{kFaultDelayParameter, 0.5};
  delay.description = "How much later each message is sent with fault 'slow', s";
  delay.range = {kLeastDelay_s, kMostDelay_s};
  if (fault == nullptr) {
    kind.fixed_because = delay.fixed_because = kNotAllowed;
  } else {
    kind.change = [fault](const ParameterValue& value) { return fault->Set(value); };
    delay.change = [fault](const ParameterValue& value) { return fault->SetDelay(value); };
  }
  return {kind, delay};
}

}  // namespace palpate::dds
