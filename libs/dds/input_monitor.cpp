// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/input_monitor.hpp"

#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/seconds.hpp"

namespace palpate::dds {

namespace {

constexpr auto kLookPeriod = std::chrono::milliseconds(500);

double Now_s() { return NsToSeconds(MonotonicNow_ns()); }

}  // namespace

InputMonitor::InputMonitor(const Participant& participant, WaitSet& loop, NodeLog& log)
    : log_(log), lines_(participant.domain_id(), Now_s()) {
  loop.Every(kLookPeriod, [this] { Look(); });
  if (const Endpoint* clock = participant.clock()->reader()) {
    Expect(*clock, "palpate-player with publish_clock, or ros2 bag play --clock,");
  }
}

void InputMonitor::Expect(const Endpoint& reader, const std::string& publisher, InputKind kind,
                          IsNeeded is_needed) {
  Expect(reader, InputName{.publisher = publisher, .kind = kind}, std::move(is_needed));
}

void InputMonitor::Expect(const Endpoint& reader, InputName input, IsNeeded is_needed) {
  input.topic = reader.ros_name();
  lines_.Add(std::move(input));
  watched_.push_back({&reader, std::move(is_needed)});
}

void InputMonitor::Look() {
  std::vector<InputState> states;
  for (const Watched& watched : watched_) {
    const EndpointCounters& counters = watched.reader->counters();
    states.push_back({.taken = counters.taken,
                      .publishers = counters.matched,
                      .publishers_ever = counters.matched_ever,
                      .incompatible_qos = counters.incompatible_qos,
                      .incompatible_policy = PolicyName(counters.last_incompatible_policy),
                      .needed = !watched.is_needed || watched.is_needed()});
  }
  for (const InputLines::Line& line : lines_.Advance(Now_s(), states)) {
    log_.Write(line.severity, line.text);
  }
}

}  // namespace palpate::dds
