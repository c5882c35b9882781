// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace palpate::command {

/// A true force, N, and its location on the deformed body, m; robot frame.
struct TrueContact {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
};

/// What samples say of the times between them.
struct TruthTiming {
  double same_time_s = 0.005;  ///< a sample this near counts as of that time
  double longest_gap_s = 0.5;  ///< forces are interpolated between samples at most this far apart
  /// Instead, each sample holds until the next one; before the first one there is no force. A
  /// single sample holds always.
  bool holds = false;
};

/// True forces over time, from samples.
class TruthTimeline {
 public:
  explicit TruthTimeline(const TruthTiming& timing = {}) : timing_(timing) {}

  /// Samples whose time does not rise are left out.
  void Add(double t_s, std::vector<TrueContact> contacts);

  /// The forces at `t_s`: those of a sample of that time, else interpolated linearly; a force
  /// that only one neighbour has counts in that neighbour's half. nullopt where the truth of that
  /// time is not known.
  std::optional<std::vector<TrueContact>> At(double t_s) const;

  /// Whether all of the `window_s` before `t_s` is known and the size of the force named varied by
  /// no more than `share` of it meanwhile.
  bool IsSteady(const std::string& name, double t_s, double window_s, double share) const;

  bool empty() const { return samples_.empty(); }
  double last_s() const { return samples_.empty() ? 0.0 : samples_.back().t_s; }
  std::vector<double> times_s() const;  ///< of the samples
  double LargestForce_N() const;        ///< 0 without a force
  /// The longest time between two samples: steadiness cannot be seen within less. 0 where samples
  /// hold.
  double LongestPeriod_s() const;

 private:
  struct Sample {
    double t_s = 0.0;
    std::vector<TrueContact> contacts;
  };
  std::vector<Sample>::const_iterator NotBefore(double t_s) const;
  const Sample* SampleAt(double t_s) const;
  std::optional<std::vector<TrueContact>> HeldAt(double t_s) const;

  TruthTiming timing_;
  std::vector<Sample> samples_;  ///< rising times
};

}  // namespace palpate::command
