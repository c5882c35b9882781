// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/monitor/held_motion.hpp"

namespace palpate::force_estimation {

/// What the watch has to say.
struct DriftReport {
  enum class State {
    kLearning,  ///< where the held skin was at the start of the sequence is not known yet
    kHolds,
    kMoved,    ///< since then, or from where the calibration has it
    kNotSeen,  ///< too little of it lately
  };
  State state = State::kLearning;
  Motion motion = Motion::Zero();          ///< of the last second
  Motion standard_error = Motion::Zero();  ///< of that
  /// For a person, where the state is kMoved: how far, and what to do.
  std::string advice;
};

/// "learning", "holds", "moved", "not_seen".
std::string ToString(DriftReport::State state);

/// As /diagnostics has it: the state, then shift and turn with their standard errors.
void AppendDrift(const DriftReport& report,
                 std::vector<std::pair<std::string, std::string>>* values);

/// Watches whether the calibration of the camera still holds: what is glued down should not seem to
/// move, nor all markers together. Frames of one second make a mean, whose covariance the scatter
/// of the frames tells; that of the first five is the reference. It says moved after two seconds in
/// a row that, alone or with the two before, differ from the reference by more than five standard
/// deviations of both and of what may pass for rest (0.25 mm and 0.7 mrad: a force that acts on the
/// held skin itself, cables that move), and holds again after two that do not; and where the
/// reference itself is as far from the calibration, allowing for 0.8 mm and 8 mrad (the depth
/// image's smooth error).
class ExtrinsicsDriftMonitor {
 public:
  /// `what`: seems to move, for the advice.
  explicit ExtrinsicsDriftMonitor(std::string what = "what is held of the body")
      : what_(std::move(what)) {}

  /// `t_s` of the camera's clock; a time before the last one begins anew.
  void Add(double t_s, const MotionSighting& seen);
  const DriftReport& report() const { return report_; }

 private:
  using Matrix = Eigen::Matrix<double, 6, 6>;
  /// Of the frames of one second.
  struct Second {
    double begin_s = 0.0;
    int frames = 0;
    int seen = 0;
    Matrix information = Matrix::Zero();
    Motion pull = Motion::Zero();
    double squares = 0.0;  ///< sum of m' information m
  };
  struct Mean {
    Motion motion = Motion::Zero();
    Matrix covariance = Matrix::Zero();
  };

  static Mean MeanOf(const Second& second);
  static Mean Together(const std::deque<Mean>& means);
  void Close();
  void Learn();
  void Judge(const Mean& mean);
  bool IsOff(const Mean& mean) const;
  void Say(const Motion& motion, const std::string& since);

  std::string what_;
  Second second_;
  double last_s_ = 0.0;
  std::deque<Mean> seconds_;  ///< the last ones; at first those of the reference
  bool has_reference_ = false;
  Mean reference_;
  bool reference_is_off_ = false;
  int in_a_row_ = 0;  ///< seconds that speak against what is said
  DriftReport report_;
};

}  // namespace palpate::force_estimation
