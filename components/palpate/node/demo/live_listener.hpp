// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "components/palpate/compare/live_comparison.hpp"
#include "components/palpate/compare/stage_times.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::command {

/// Listens to the whole system: /forces, the model's state, how the components fare, and, of the
/// virtual bench, /truth/forces, with which it compares the estimates, and what tells where a
/// frame's time goes. Nothing that it hears goes back to those who estimate.
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
  /// Of the virtual bench; of recordings, whose stamps are of another day, nothing.
  const StageTimes& stages() const { return stages_; }

 private:
  /// What only the virtual bench is asked for.
  struct BenchReaders {
    dds::Reader<idl::palpate_msgs::ForceArray> truth;
    dds::Reader<idl::palpate_msgs::FrameInfo> pictures;
    dds::Reader<idl::palpate_msgs::PerceptionReport> perceived;
  };

  void TakeForces();
  void TakeTruth();
  void TakeMeshStates();
  void TakeReports();
  void TakePictures();
  void TakePerceived();
  void PassEstimated(const idl::palpate_msgs::ForceArray& message, double heard_s);

  bool with_truth_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  std::optional<BenchReaders> bench_;
  std::map<std::string, std::string> reports_;  ///< by component; empty: it is well
  LiveComparison comparison_;
  StageTimes stages_;
  LiveComparison::TakeFrame take_;
};

}  // namespace palpate::command
