// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/faults/system_listener.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace palpate::system_test {

SystemListener::SystemListener()
    : forces_(node_.participant.CreateReader(dds::kForcesTopic)),
      statuses_(node_.participant.CreateReader(dds::kComponentStatusTopic)),
      diagnostics_(node_.participant.CreateReader(dds::kDiagnosticsTopic)) {
  node_.loop.Attach(forces_, [this] { TakeForces(); });
  node_.loop.Attach(statuses_, [this] { TakeStatuses(); });
  node_.loop.Attach(diagnostics_, [this] { TakeDiagnostics(); });
}

void SystemListener::Forget() {
  reports_.clear();
  last_ = {};
  in_a_row_ = 0;
  estimates_in_a_row_ = 0;
}

void SystemListener::TakeForces() {
  for (const auto& message : forces_.Take()) {
    Answer answer{.stamp_ns = dds::StampNs(message.header.stamp),
                  .status = std::string(dds::Text(message.status)),
                  .reason = std::string(dds::Text(message.reason)),
                  .age_s = message.age_s,
                  .when = Clock::now()};
    for (const auto& force : dds::Elements(message.forces)) {
      const std::string_view status = dds::Text(force.status);
      if (status != "ok" && status != "hidden" && status != "uncertain") continue;
      ++answer.usable;
      const double size_N = std::hypot(force.force_n.x, force.force_n.y, force.force_n.z);
      if (!(size_N <= answer.largest_N)) answer.largest_N = size_N;
    }
    const bool is_new = answer.stamp_ns > last_.stamp_ns;
    in_a_row_ = answer.status == "ok" && answer.usable > 0 && is_new ? in_a_row_ + 1 : 0;
    const bool is_estimate = answer.status == "ok" || answer.status == "no_contact" ||
                             answer.status == "uncertain" || answer.status == "hidden";
    estimates_in_a_row_ = is_estimate && is_new ? estimates_in_a_row_ + 1 : 0;
    last_ = std::move(answer);
    ++answers_;
  }
}

void SystemListener::TakeStatuses() {
  for (const auto& message : statuses_.Take()) {
    Report& report = reports_[std::string(dds::Text(message.component_name))];
    report.status = dds::Text(message.status);
    report.reason = dds::Text(message.reason);
    ++report.count;
  }
}

void SystemListener::TakeDiagnostics() {
  for (const auto& message : diagnostics_.Take()) {
    for (const auto& entry : dds::Elements(message.status)) {
      const std::string_view name = dds::Text(entry.name);
      Report& report = reports_[std::string(name.substr(name.rfind(' ') + 1))];
      report.values.clear();
      for (const auto& value : dds::Elements(entry.values)) {
        report.values[std::string(dds::Text(value.key))] = dds::Text(value.value);
      }
    }
  }
}

std::ostream& operator<<(std::ostream& stream, const SystemListener::Answer& answer) {
  return stream << "/forces " << answer.status << " '" << answer.reason << "', " << answer.usable
                << " usable, largest " << answer.largest_N << " N, age " << answer.age_s << " s";
}

std::ostream& operator<<(std::ostream& stream, const SystemListener::Report& report) {
  stream << report.status << " '" << report.reason << "'";
  for (const char* key : {"waiting_for", "fault_on_command", "drift", "model_gap"}) {
    const auto found = report.values.find(key);
    if (found != report.values.end()) stream << ", " << key << " '" << found->second << "'";
  }
  return stream;
}

}  // namespace palpate::system_test
