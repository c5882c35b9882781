// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/dds/clock_offsets.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/sole_writers.hpp"

namespace palpate::dds {

/// What a component counts about itself since its start.
struct HealthCounts {
  uint64_t received = 0;
  uint64_t published = 0;
  uint64_t dropped = 0;             ///< lost on the way, or overtaken by a newer message
  uint64_t refused = 0;             ///< taken but not usable
  std::vector<double> latencies_s;  ///< of the messages since the last report
};

/// Says once a second how a component fares, on /component_status for our own tools and on
/// /diagnostics for those of ROS. Measures the offsets to the clocks of other hosts, and gives them
/// to the participant's clock. Another process that writes what this one alone may write
/// (SoleWriters) is an error of this one.
class HealthReporter {
 public:
  using Clock = std::chrono::steady_clock;
  using KeysAndValues = std::vector<std::pair<std::string, std::string>>;

  /// `participant` must outlive this.
  HealthReporter(Participant& participant, std::string component_name, Clock::time_point start);

  /// `extra`: further values for /diagnostics. Rates are counted since the last report. Throws
  /// RunError where this process has just started and another one writes the same.
  void Report(const Status& status, const HealthCounts& counts, const KeysAndValues& extra,
              Clock::time_point now);

  /// The clock that stamps a topic, by its ROS name; nullopt: nobody writes it, or that process
  /// does not tell its host, as those of ROS 2.
  std::optional<StampClock> ClockOf(const std::string& ros_name);

  /// Reports that DDS did not take.
  uint64_t failed_count() const { return status_.failed_count() + diagnostics_.failed_count(); }

 private:
  Message<idl::palpate_msgs::ComponentStatus> Fill(const Status& status, const HealthCounts& counts,
                                                   Clock::time_point now) const;
  Message<idl::diagnostic_msgs::DiagnosticArray> Translate(
      const idl::palpate_msgs::ComponentStatus& status, bool ok,
      const std::vector<std::pair<std::string, std::string>>& extra) const;

  Status WithConflict(const Status& status, Clock::time_point now);
  void ExchangeClocks();
  KeysAndValues ClockValues() const;

  Participant& participant_;
  std::string component_name_;
  std::string node_name_;
  std::shared_ptr<RosClock> clock_;
  Clock::time_point start_;
  Clock::time_point last_report_;
  uint64_t last_received_ = 0;
  uint64_t last_published_ = 0;
  Writer<idl::palpate_msgs::ComponentStatus> status_;
  Writer<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
  SoleWriters sole_writers_;
  std::string conflict_;  ///< that was logged last; empty: none now
  ClockOffsets clock_offsets_;
  std::optional<ClockOffset> frames_clock_;  ///< the last one that was known
};

}  // namespace palpate::dds
