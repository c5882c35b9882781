// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/node_log.hpp"

#include <utility>

#include "libs/dds/stamp.hpp"

namespace palpate::dds {

NodeLog::NodeLog(Participant& participant, ProcessLog process_log)
    : participant_(participant),
      node_name_(participant.node_name()),
      clock_(participant.clock()),
      process_log_(std::move(process_log)),
      writer_(participant.CreateWriter(kRosoutTopic)) {
  participant.SetLog([this](Severity severity, std::string_view text) { Write(severity, text); });
}

void NodeLog::Write(Severity severity, std::string_view text) {
  const std::lock_guard lock(mutex_);
  WriteLocked(severity, text);
}

void NodeLog::WarnRepeatedly(const std::string& text, const std::string& latest) {
  const std::lock_guard lock(mutex_);
  if (const auto line = repeated_.Add(text, latest)) WriteLocked(Severity::kWarning, *line);
}

void NodeLog::WriteCounted() {
  const std::lock_guard lock(mutex_);
  for (const std::string& line : repeated_.TakeDue()) WriteLocked(Severity::kWarning, line);
}

void NodeLog::WriteLocked(Severity severity, std::string_view text) {
  if (process_log_) process_log_(severity, text);
  Message<idl::rcl_interfaces::Log> line;
  line->stamp = TimeFromNs(clock_->Now_ns());
  line->level = static_cast<uint8_t>(severity);
  SetText(line->name, node_name_);
  SetText(line->msg, text);
  const bool sent = writer_.Write(line);
  if (!sent && process_log_) process_log_(Severity::kWarning, "/rosout did not take the last line");
}

}  // namespace palpate::dds
