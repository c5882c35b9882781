// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/error_consistency.hpp"
#include "components/palpate/compare/force_comparison.hpp"

namespace palpate::command {

/// Accuracy of the forces of one kind, over the frames in which they were due and detected
/// (docs/force_metrics.md). NaN where there is no such frame.
struct ForceScore {
  int frames = 0;
  double mean_relative_error = 0.0;
  double median_relative_error = 0.0;
  double p95_relative_error = 0.0;  ///< 95 % of the errors are no larger
  double bias_N = 0.0;              ///< mean of the error of |F|, with its sign
  double median_error_N = 0.0;      ///< of |F|
  double p95_error_N = 0.0;
  double median_along_N = 0.0;   ///< of the force's error along the true force
  double median_across_N = 0.0;  ///< and across it, where all of the force was observable
  double median_location_error_m = 0.0;
  double p95_location_error_m = 0.0;
  double mean_direction_error_rad = 0.0;  ///< of those whose direction was observable
  double coverage = 0.0;                  ///< share whose true magnitude lies in the 95 % interval
  double location_coverage = 0.0;         ///< share whose true location lies in its 95 % interval
  /// Of the forces, and of the places, that have a covariance.
  force_estimation::ErrorConsistency consistency = {}, location_consistency = {};
};

/// Estimates against truth over a whole run.
class ComparisonSummary {
 public:
  /// The comparison of one frame that had a result and a truth.
  void Add(const std::vector<ComparedForce>& frame);

  int frames() const { return frames_; }
  int found() const { return static_cast<int>(seen_.size() + hidden_.size() + together_.size()); }
  ForceScore Seen() const;      ///< one force, the camera sees the contact
  ForceScore Hidden() const;    ///< one force, the camera does not
  ForceScore Together() const;  ///< of two or more at once
  ForceScore All() const;
  int due() const { return due_; }        ///< true forces that had to be detected
  int misses() const { return misses_; }  ///< of these
  int false_alarms() const { return false_alarms_; }
  int frames_with_false_alarm() const { return frames_with_false_alarm_; }

  /// Lines of text, indented, each with its line end.
  std::string ToText() const;

 private:
  std::vector<ComparedForce> seen_;
  std::vector<ComparedForce> hidden_;
  std::vector<ComparedForce> together_;
  int frames_ = 0;
  int due_ = 0;
  int misses_ = 0;
  int false_alarms_ = 0;
  int frames_with_false_alarm_ = 0;
};

}  // namespace palpate::command
