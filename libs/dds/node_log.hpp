// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "libs/core/repeated_warning.hpp"
#include "libs/core/severity.hpp"
#include "libs/dds/participant.hpp"

namespace palpate::dds {

/// The log of a node: each line goes to /rosout and to the log of the process. Safe from any
/// thread.
class NodeLog {
 public:
  using ProcessLog = std::function<void(Severity, std::string_view)>;

  /// `process_log` may be empty.
  /// `participant` must outlive this.
  NodeLog(Participant& participant, ProcessLog process_log);
  ~NodeLog() { participant_.SetLog({}); }
  NodeLog(const NodeLog&) = delete;
  NodeLog& operator=(const NodeLog&) = delete;

  void Write(Severity severity, std::string_view text);

  /// A warning that may come with each frame: the first at once, further ones counted
  /// (RepeatedWarning). `latest` tells this one from the others: StampText() of its frame.
  void WarnRepeatedly(const std::string& text, const std::string& latest = {});
  /// Writes the lines of the warnings that were counted; to be called about once a second.
  void WriteCounted();

 private:
  void WriteLocked(Severity severity, std::string_view text);

  Participant& participant_;
  std::mutex mutex_;
  std::string node_name_;
  std::shared_ptr<RosClock> clock_;
  ProcessLog process_log_;
  Writer<idl::rcl_interfaces::Log> writer_;
  RepeatedWarning repeated_;
};

}  // namespace palpate::dds
