// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "components/palpate/compare/live_comparison.hpp"
#include "components/palpate/compare/stage_times.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::command {

/// Listens to the whole system: /forces, the mesh state, the components' status, and, of the
/// virtual robot, /truth/forces to compare with and the stamps of each stage. It publishes nothing,
/// so that the truth cannot reach the estimator.
class LiveListener {
 public:
  enum class Truth { kKnown, kNone };

  /// `same_place_m` as in ComparisonRules. Throws RunError where DDS refuses.
  LiveListener(int domain_id, Truth truth, const std::vector<std::string>& remap = {},
               double same_place_m = ComparisonRules().same_place_m);

  /// Takes messages until `done()` holds, which is asked at least every 50 ms; false where `limit`
  /// passes before. `take` gets each compared frame.
  bool Listen(
      const std::function<bool()>& done, std::chrono::duration<double> limit,
      const LiveComparison::TakeFrame& take = [](const auto&, const auto&) {});

  /// Whether a status of the component has arrived.
  bool Heard(const std::string& component) const { return reports_.contains(component); }
  /// Where the virtual robot is in its scenario. It falls behind the clock on a slow computer.
  struct BenchTime {
    std::uint32_t recording = 0;
    double t_s = 0.0;
  };
  const BenchTime& bench_time() const { return bench_time_; }
  /// The status of components that are not ok; lines of text, each with its line end.
  std::string Troubles() const;

  const LiveComparison& comparison() const { return comparison_; }
  /// Of the virtual robot; empty for recordings, whose stamps are in the past.
  const StageTimes& stages() const { return stages_; }

 private:
  /// Topics that only the virtual robot has.
  struct BenchReaders {
    dds::Reader<idl::palpate_msgs::ForceArray> truth;
    dds::Reader<idl::palpate_msgs::FrameInfo> frames;
    dds::Reader<idl::palpate_msgs::PerceptionReport> perceived;
    dds::Reader<idl::palpate_msgs::BenchState> state;
  };

  void TakeForces();
  void TakeTruth();
  void TakeMeshStates();
  void TakeReports();
  void TakeFrameInfos();
  void TakePerceived();
  void PassEstimated(const idl::palpate_msgs::ForceArray& message, double heard_s);

  bool with_truth_;
  BenchTime bench_time_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  std::optional<BenchReaders> bench_;
  std::map<std::string, std::string> reports_;  ///< by component; empty: ok
  LiveComparison comparison_;
  StageTimes stages_;
  LiveComparison::TakeFrame take_;
};

}  // namespace palpate::command
