// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/health.hpp"

#include <algorithm>

#include "libs/core/seconds.hpp"
#include "libs/core/statistics.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::dds {

namespace {

using KeysAndValues = std::vector<std::pair<std::string, std::string>>;

double MeanOr0(const std::vector<double>& values) { return values.empty() ? 0.0 : Mean(values); }

double Max(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

KeysAndValues ValuesOf(const idl::palpate_msgs::ComponentStatus& status) {
  return {{"status", std::string(Text(status.status))},
          {"uptime_s", FormatNumber(status.uptime_s)},
          {"received", std::to_string(status.received)},
          {"published", std::to_string(status.published)},
          {"dropped", std::to_string(status.dropped)},
          {"refused", std::to_string(status.refused)},
          {"input_rate_hz", FormatNumber(status.input_rate_hz)},
          {"output_rate_hz", FormatNumber(status.output_rate_hz)},
          {"latency_mean_s", FormatNumber(status.latency_mean_s)},
          {"latency_max_s", FormatNumber(status.latency_max_s)}};
}

}  // namespace

HealthReporter::HealthReporter(Participant& participant, std::string component_name,
                               Clock::time_point start)
    : component_name_(std::move(component_name)),
      node_name_(participant.node_name()),
      clock_(participant.clock()),
      start_(start),
      last_report_(start),
      status_(participant.CreateWriter(kComponentStatusTopic)),
      diagnostics_(participant.CreateWriter(kDiagnosticsTopic)) {}

void HealthReporter::Report(const Status& status, const HealthCounts& counts,
                            const KeysAndValues& extra, Clock::time_point now) {
  const auto message = Fill(status, counts, now);
  // A report that is not taken shows in failed_count(); the next one follows in a second.
  (void)status_.Write(message);
  (void)diagnostics_.Write(Translate(*message, status.ok(), extra));
  last_report_ = now;
  last_received_ = counts.received;
  last_published_ = counts.published;
}

Message<idl::palpate_msgs::ComponentStatus> HealthReporter::Fill(const Status& status,
                                                                 const HealthCounts& counts,
                                                                 Clock::time_point now) const {
  Message<idl::palpate_msgs::ComponentStatus> message;
  SetHeader(message->header, clock_->Now_ns(), "");
  SetText(message->component_name, component_name_);
  SetText(message->status, ToString(status.code()));
  SetText(message->reason, status.message());
  message->uptime_s = ToSeconds(now - start_);
  message->received = counts.received;
  message->published = counts.published;
  message->dropped = counts.dropped;
  message->refused = counts.refused;
  const double interval_s = ToSeconds(now - last_report_);
  if (interval_s > 0.0) {
    message->input_rate_hz = static_cast<double>(counts.received - last_received_) / interval_s;
    message->output_rate_hz = static_cast<double>(counts.published - last_published_) / interval_s;
  }
  message->latency_mean_s = MeanOr0(counts.latencies_s);
  message->latency_max_s = Max(counts.latencies_s);
  return message;
}

Message<idl::diagnostic_msgs::DiagnosticArray> HealthReporter::Translate(
    const idl::palpate_msgs::ComponentStatus& status, bool ok, const KeysAndValues& extra) const {
  Message<idl::diagnostic_msgs::DiagnosticArray> array;
  SetHeader(array->header, StampNs(status.header.stamp), "");
  Resize(array->status, 1);
  auto& entry = array->status._buffer[0];
  entry.level = ok ? diagnostic_msgs_msg_DiagnosticStatus_Constants_OK
                   : diagnostic_msgs_msg_DiagnosticStatus_Constants_ERROR;
  SetText(entry.name, node_name_ + ": " + component_name_);
  SetText(entry.message, ok ? Text(status.status) : Text(status.reason));
  KeysAndValues values = ValuesOf(status);
  values.insert(values.end(), extra.begin(), extra.end());
  Resize(entry.values, values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    SetText(entry.values._buffer[i].key, values[i].first);
    SetText(entry.values._buffer[i].value, values[i].second);
  }
  return array;
}

}  // namespace palpate::dds
