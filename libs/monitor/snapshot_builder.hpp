// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "libs/dds/topics.hpp"
#include "libs/monitor/system_snapshot.hpp"
#include "libs/monitor/topic_flow.hpp"

namespace palpate::monitor {

/// Turns the messages of a running system into what a person is shown. Reads messages, but joins no
/// domain; time is an argument, s of any clock.
class SnapshotBuilder {
 public:
  explicit SnapshotBuilder(int domain_id) { snapshot_.domain_id = domain_id; }

  void Add(const idl::palpate_msgs::ComponentStatus& message, double now_s);
  void Add(const idl::diagnostic_msgs::DiagnosticArray& message, double now_s);
  void Add(const idl::palpate_msgs::ForceArray& message, double now_s);
  void Add(const idl::palpate_msgs::ModelGap& message, double now_s);
  void Add(const idl::palpate_msgs::PerceptionReport& message, double now_s);
  void Add(const idl::palpate_msgs::FrameInfo& message, double now_s);
  void Add(const idl::palpate_msgs::MeshState& message, double now_s);
  void Add(const idl::sensor_msgs::JointState& message, double now_s);
  void Add(const idl::palpate_msgs::CalibrationStatus& message);

  /// The joints that are chambers; at first none. Joint states do not say it.
  void SetChambers(std::set<std::string> chambers) { chambers_ = std::move(chambers); }

  /// Processes that have reported.
  std::size_t processes() const { return processes_.size(); }

  /// `time_ns`: the same time since 1970, UTC.
  SystemSnapshot At(double now_s, std::int64_t time_ns) const;

 private:
  using Values = std::vector<std::pair<std::string, std::string>>;
  struct Reported {
    ProcessState state;
    double report_s = 0.0;
  };
  struct Other {
    OtherDiagnosis diagnosis;
    double report_s = 0.0;
  };

  std::set<std::string> chambers_;
  std::map<std::string, Reported> processes_;  ///< by name
  std::map<std::string, Values> values_;       ///< of /diagnostics, by the process' name
  std::map<std::string, Other> others_;        ///< by name
  SystemSnapshot snapshot_;                    ///< without flows and processes
  FlowCounter forces_;
  FlowCounter model_error_;
  FlowCounter perception_;
  FlowCounter camera_;
  FlowCounter mesh_;
  FlowCounter cables_;
};

}  // namespace palpate::monitor
