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

/// True forces over time, from samples.
class TruthTimeline {
 public:
  /// Maximum distance of samples between which forces are interpolated.
  static constexpr double kLongestGap_s = 0.5;
  /// Tolerance of stamps of the camera and of the virtual robot.
  static constexpr double kSameTime_s = 0.005;

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

 private:
  struct Sample {
    double t_s = 0.0;
    std::vector<TrueContact> contacts;
  };
  const Sample* SampleAt(double t_s) const;

  std::vector<Sample> samples_;  ///< rising times
};

}  // namespace palpate::command
