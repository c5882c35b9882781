// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/dds/participant.hpp"

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
/// /diagnostics for those of ROS.
class HealthReporter {
 public:
  using Clock = std::chrono::steady_clock;

  HealthReporter(Participant& participant, std::string component_name, Clock::time_point start);

  /// `extra`: further values for /diagnostics. Rates are counted since the last report.
  void Report(const Status& status, const HealthCounts& counts,
              const std::vector<std::pair<std::string, std::string>>& extra, Clock::time_point now);

  /// Reports that DDS did not take.
  uint64_t failed_count() const { return status_.failed_count() + diagnostics_.failed_count(); }

 private:
  Message<idl::palpate_msgs::ComponentStatus> Fill(const Status& status, const HealthCounts& counts,
                                                   Clock::time_point now) const;
  Message<idl::diagnostic_msgs::DiagnosticArray> Translate(
      const idl::palpate_msgs::ComponentStatus& status, bool ok,
      const std::vector<std::pair<std::string, std::string>>& extra) const;

  std::string component_name_;
  std::string node_name_;
  std::shared_ptr<RosClock> clock_;
  Clock::time_point start_;
  Clock::time_point last_report_;
  uint64_t last_received_ = 0;
  uint64_t last_published_ = 0;
  Writer<idl::palpate_msgs::ComponentStatus> status_;
  Writer<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
};

}  // namespace palpate::dds
