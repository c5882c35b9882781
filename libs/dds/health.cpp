// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/health.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/statistics.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::dds {

namespace {

using KeysAndValues = HealthReporter::KeysAndValues;

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
    : participant_(participant),
      component_name_(std::move(component_name)),
      node_name_(participant.node_name()),
      clock_(participant.clock()),
      start_(start),
      last_report_(start),
      status_(participant.CreateWriter(kComponentStatusTopic)),
      diagnostics_(participant.CreateWriter(kDiagnosticsTopic)),
      sole_writers_(participant, start),
      clock_offsets_(participant) {}

void HealthReporter::Report(const Status& status, const HealthCounts& counts,
                            const KeysAndValues& extra, Clock::time_point now) {
  const Status judged = WithConflict(status, now);
  ExchangeClocks();
  KeysAndValues values = ClockValues();
  if (const CommandedFault* fault = participant_.fault()) {
    values.emplace_back("fault_on_command", ToString(fault->kind()));
  }
  values.insert(values.end(), extra.begin(), extra.end());
  const auto message = Fill(judged, counts, now);
  // A report that is not taken shows in failed_count(); the next one follows in a second.
  (void)status_.Write(message);
  (void)diagnostics_.Write(Translate(*message, judged.ok(), values));
  last_report_ = now;
  last_received_ = counts.received;
  last_published_ = counts.published;
}

Status HealthReporter::WithConflict(const Status& status, Clock::time_point now) {
  const auto conflict = sole_writers_.Find(now);
  if (conflict && conflict->came_later) throw RunError(conflict->reason);
  const std::string reason = conflict ? conflict->reason : std::string();
  if (reason != std::exchange(conflict_, reason)) {
    if (reason.empty()) {
      participant_.WriteLog(Severity::kInfo, "this process is the only writer of its topics again");
    } else {
      participant_.WriteLog(Severity::kError, reason);
    }
  }
  return reason.empty() ? status : Status(StatusCode::kInvalidInput, reason);
}

void HealthReporter::ExchangeClocks() {
  const std::string frames = participant_.ResolvedName(kFrameInfoTopic.name);
  const std::string cables = participant_.ResolvedName(kJointStatesTopic.name);
  std::vector<std::string> stamped;
  for (const Participant::Written& topic : participant_.written()) {
    if (topic.ros_name == frames || topic.ros_name == cables) stamped.push_back(topic.ros_name);
  }
  clock_offsets_.Send(stamped);
  const auto ns_of = [](const std::optional<ClockOffset>& offset) {
    return offset ? std::llround(1e9 * offset->offset_s) : 0LL;
  };
  // Where the camera's host is gone, frames of further cameras still have its clock.
  if (const auto heard = clock_offsets_.Of(frames)) frames_clock_ = heard;
  const auto& of_frames = frames_clock_;
  const auto of_cables = clock_offsets_.Of(cables);
  // Where one of the two is not known, stamps of cable inputs stay as they are.
  const bool are_known = of_frames && of_cables;
  clock_->SetOffsets(ns_of(of_frames), ns_of(are_known ? of_cables : of_frames));
}

std::optional<StampClock> HealthReporter::ClockOf(const std::string& ros_name) {
  const auto writer = sole_writers_.WriterOf(ros_name);
  if (!writer) return std::nullopt;
  return StampClock{writer->host, clock_offsets_.OfHost(writer->host.id)};
}

HealthReporter::KeysAndValues HealthReporter::ClockValues() const {
  KeysAndValues values = {{"host", ThisHost().name}};
  for (const HostClock& clock : clock_offsets_.All()) {
    values.emplace_back("clock_offset_s." + clock.host.name, FormatNumber(clock.offset.offset_s));
    values.emplace_back("clock_offset_bound_s." + clock.host.name,
                        FormatNumber(clock.offset.bound_s));
  }
  return values;
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
