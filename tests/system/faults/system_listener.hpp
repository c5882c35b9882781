// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <ostream>
#include <string>

#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::system_test {

/// Hears what the processes of a system say: how each fares, and the forces.
class SystemListener {
 public:
  using Clock = std::chrono::steady_clock;

  /// What a component says of itself.
  struct Report {
    std::string status;
    std::string reason;
    std::map<std::string, std::string> values;  ///< of /diagnostics
    std::uint64_t count = 0;                    ///< messages that were heard
  };
  /// One message on /forces.
  struct Answer {
    std::int64_t stamp_ns = 0;
    std::string status;
    std::string reason;
    double age_s = 0.0;
    double largest_N = 0.0;  ///< of the forces that may be used; 0: there is none
    std::uint64_t usable = 0;
    Clock::time_point when;
  };

  SystemListener();

  const Report& Of(const std::string& component) { return reports_[component]; }
  const Answer& last() const { return last_; }
  std::uint64_t answers() const { return answers_; }
  /// Answers in a row with usable forces under a new stamp.
  int forces_in_a_row() const { return in_a_row_; }
  /// Answers in a row that are estimates, be it that there is no contact, under a new stamp.
  int estimates_in_a_row() const { return estimates_in_a_row_; }
  /// Until now the last answer is of no interest, and no report.
  void Forget();

  template <typename Condition>
  bool WaitFor(const Condition& condition, std::chrono::seconds at_most) {
    return node_.loop.DispatchUntil(condition, Clock::now() + at_most);
  }
  void ListenFor(std::chrono::milliseconds duration) {
    node_.loop.DispatchUntil([] { return false; }, Clock::now() + duration);
  }
  dds_entity_t participant() const { return node_.participant.handle(); }

 private:
  void TakeForces();
  void TakeStatuses();
  void TakeDiagnostics();

  dds::TestNode node_{"system_listener"};
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  dds::Reader<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
  std::map<std::string, Report> reports_;  ///< by component
  Answer last_;
  std::uint64_t answers_ = 0;
  int in_a_row_ = 0;
  int estimates_in_a_row_ = 0;
};

/// For messages of tests.
std::ostream& operator<<(std::ostream& stream, const SystemListener::Answer& answer);
std::ostream& operator<<(std::ostream& stream, const SystemListener::Report& report);

}  // namespace palpate::system_test
