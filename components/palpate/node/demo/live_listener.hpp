// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "components/palpate/compare/live_comparison.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::command {

/// Listens to the whole system: /forces, the model's state, how the components fare, and, of the
/// virtual bench, /truth/forces, with which it compares the estimates. Nothing that it hears goes
/// back to those who estimate.
class LiveListener {
 public:
  enum class Truth { kKnown, kNone };

  /// Throws RunError where DDS refuses.
  LiveListener(int domain_id, Truth truth);

  /// Takes messages until `done()` holds, which is asked at least every 50 ms; false where `limit`
  /// passes before. `take` gets each compared frame.
  bool Listen(
      const std::function<bool()>& done, std::chrono::duration<double> limit,
      const LiveComparison::TakeFrame& take = [](const auto&, const auto&) {});

  /// Whether the component has told how it fares.
  bool Heard(const std::string& component) const { return reports_.contains(component); }
  /// How those fare that are not well; lines, each ended.
  std::string Troubles() const;

  const LiveComparison& comparison() const { return comparison_; }

 private:
  void TakeForces();
  void TakeTruth();
  void TakeMeshStates();
  void TakeReports();

  bool with_truth_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  std::optional<dds::Reader<idl::palpate_msgs::ForceArray>> truth_;
  std::map<std::string, std::string> reports_;  ///< by component; empty: it is well
  LiveComparison comparison_;
  LiveComparison::TakeFrame take_;
};

}  // namespace palpate::command
