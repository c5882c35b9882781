// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/wait_set.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::dds {

namespace {

void AttachTo(dds_entity_t wait_set, dds_entity_t condition, void* argument) {
  const dds_return_t result =
      dds_waitset_attach(wait_set, condition, reinterpret_cast<dds_attach_t>(argument));
  if (result != DDS_RETCODE_OK) {
    throw RunError(std::string("cannot attach to a waitset: ") + dds_strretcode(-result));
  }
}

dds_duration_t TimeLeft(WaitSet::Clock::time_point deadline) {
  if (deadline == WaitSet::Clock::time_point::max()) return DDS_INFINITY;
  const auto left = std::chrono::ceil<std::chrono::nanoseconds>(deadline - WaitSet::Clock::now());
  return std::max<dds_duration_t>(0, left.count());
}

}  // namespace

WaitSet::WaitSet(const Participant& participant)
    : guard_(dds_create_guardcondition(participant.handle()), "a guard condition"),
      wait_set_(dds_create_waitset(participant.handle()), "a waitset") {
  AttachTo(wait_set_.handle(), guard_.handle(), nullptr);
  ParameterServices* parameters = participant.parameters();
  if (parameters == nullptr) return;
  for (const dds_entity_t reader : parameters->readers()) {
    Attach(reader, [parameters, reader] { parameters->Serve(reader); });
  }
}

void WaitSet::Attach(dds_entity_t reader, std::function<void()> on_data) {
  Entity condition(dds_create_readcondition(reader, DDS_ANY_STATE), "a read condition");
  sources_.push_back(std::make_unique<Source>(Source{std::move(condition), std::move(on_data)}));
  AttachTo(wait_set_.handle(), sources_.back()->condition.handle(), sources_.back().get());
}

void WaitSet::Every(Clock::duration period, std::function<void()> on_time) {
  PALPATE_CHECK(period > Clock::duration::zero(), period.count());
  timers_.push_back({period, Clock::now() + period, std::move(on_time)});
}

Alarm& WaitSet::AddAlarm(std::function<void()> on_time) {
  return *alarms_.emplace_back(std::make_unique<Alarm>(std::move(on_time)));
}

void WaitSet::Run() {
  DispatchUntil([] { return false; }, Clock::time_point::max());
}

bool WaitSet::DispatchUntil(const std::function<bool()>& done, Clock::time_point deadline) {
  while (!stopped_) {
    if (done()) return true;
    if (Clock::now() >= deadline) return false;
    WaitForEvent(Earliest(deadline));
    CallTimers();
    CallAlarms();
  }
  return false;
}

void WaitSet::WaitForEvent(Clock::time_point deadline) {
  std::array<dds_attach_t, 16> triggered;
  const dds_return_t count =
      dds_waitset_wait(wait_set_.handle(), triggered.data(), triggered.size(), TimeLeft(deadline));
  if (count < 0) {
    throw RunError(std::string("cannot wait for messages: ") + dds_strretcode(-count));
  }
  const size_t filled = std::min(static_cast<size_t>(count), triggered.size());
  for (size_t i = 0; i < filled; ++i) {
    auto* source = reinterpret_cast<Source*>(triggered[i]);
    if (source) {
      source->on_data();
    } else {
      dds_set_guardcondition(guard_.handle(), false);
      if (on_wake_) on_wake_();
    }
  }
}

void WaitSet::CallTimers() {
  for (Timer& timer : timers_) {
    const Clock::time_point now = Clock::now();
    if (now < timer.next) continue;
    timer.on_time();
    timer.next += ((now - timer.next) / timer.period + 1) * timer.period;
  }
}

void WaitSet::CallAlarms() {
  for (const auto& alarm : alarms_) {
    if (Clock::now() < alarm->when_) continue;
    alarm->Clear();
    alarm->on_time_();
  }
}

WaitSet::Clock::time_point WaitSet::Earliest(Clock::time_point deadline) const {
  for (const Timer& timer : timers_) deadline = std::min(deadline, timer.next);
  for (const auto& alarm : alarms_) deadline = std::min(deadline, alarm->when_);
  return deadline;
}

void WaitSet::Stop() {
  stopped_ = true;
  Wake();
}

void WaitSet::Wake() { dds_set_guardcondition(guard_.handle(), true); }

}  // namespace palpate::dds
