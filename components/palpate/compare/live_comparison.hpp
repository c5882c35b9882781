// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/palpate/compare/comparison_summary.hpp"
#include "components/palpate/compare/force_tracks.hpp"
#include "components/palpate/compare/truth_timeline.hpp"

namespace palpate::command {

/// A frame to draw: the model's nodes and the forces in it.
struct ForceFrame {
  double t_s = 0.0;
  Eigen::VectorXd nodes_m;  ///< [3n]
  std::vector<ComparedForce> forces;
};

/// Compares estimates with the truth while both arrive, in any order. Times are stamps on one
/// clock, s. Forces of a tenth of the largest true one so far must be detected while they are
/// steady.
class LiveComparison {
 public:
  /// Maximum time that an estimate waits for the truth of its time.
  static constexpr double kLongestWait_s = 0.5;
  using TakeFrame = std::function<void(const force_estimation::ForceEstimate&,
                                       const std::vector<ComparedForce>&)>;

  /// `with_truth`: false where true forces are unknown; estimates are then not compared.
  /// `same_place_m` as in ComparisonRules.
  explicit LiveComparison(bool with_truth, double same_place_m = ComparisonRules().same_place_m);

  void AddTruth(double t_s, std::vector<TrueContact> contacts);
  void AddNodes(double t_s, Eigen::VectorXd nodes_m);
  /// `latency_s`: from the exposure to now; nullopt: not meaningful.
  void AddEstimate(const force_estimation::ForceEstimate& estimate,
                   std::optional<double> latency_s);
  /// Passes on the frames whose truth has arrived, or will not arrive any more; without truth the
  /// estimates alone.
  void Advance(const TakeFrame& take);

  const ComparisonSummary& summary() const { return summary_; }
  std::vector<view::ForceTrack> Tracks() const { return tracks_.Tracks(); }
  /// The frame with the largest detected steady force; without truth the largest force.
  const std::optional<ForceFrame>& best() const { return best_; }
  int frames() const { return frames_; }    ///< with an estimate; stale ones do not count
  int results() const { return results_; }  ///< frames with a result
  /// Frames a second between the first in which there is a robot and the last; NaN below two.
  double Rate_hz() const;
  const std::vector<double>& latencies_s() const { return latencies_s_; }

  /// Frames, rate, latency and accuracy; lines of text, each with its line end.
  std::string ToText() const;

 private:
  std::vector<ComparedForce> Compare(const force_estimation::ForceEstimate& estimate) const;
  void KeepIfBest(double t_s, const std::vector<ComparedForce>& compared);

  bool with_truth_;
  ComparisonRules rules_;
  double largest_N_ = 0.0;  ///< true force so far
  TruthTimeline truth_;
  std::deque<force_estimation::ForceEstimate> waiting_;
  std::map<double, Eigen::VectorXd> nodes_m_;  ///< the newest, by time
  ComparisonSummary summary_;
  ForceTracks tracks_;
  std::map<std::string, int> statuses_;
  std::optional<ForceFrame> best_;
  double best_worth_ = 0.0;
  int frames_ = 0;
  int results_ = 0;
  int frames_with_robot_ = 0;  ///< from the first of them on
  double robot_since_s_ = 0.0;
  double first_s_ = 0.0;
  double last_s_ = 0.0;
  std::vector<double> latencies_s_;
};

}  // namespace palpate::command
