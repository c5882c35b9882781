// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/force_estimation/error_consistency.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/virtual_robot/virtual_robot.hpp"

namespace palpate::test_support {

/// What an estimator makes of one true force in one frame.
struct ForceScore {
  double true_N = 0.0;
  bool found = false;             ///< nothing else is known where it was not
  double relative_error = 1.0;    ///< | |F| - |F true| | / |F true|; 1 where it was not found
  bool inside_interval = false;   ///< | |F| - |F true| | <= ci95
  double location_error_m = 0.0;  ///< from the true centre of pressure, on the deformed body
  bool inside_location = false;   ///< within location_ci95_m
  bool has_direction = false;     ///< the estimate says that all of the force was observable
  double direction_error_rad = 0.0;
};

/// The figures of issue and paper over many frames.
struct AccuracySummary {
  int forces = 0;  ///< true ones, counted in each frame
  double found_share = 0.0;
  double mean_relative_error = 0.0;  ///< what was not found counts as 1
  double median_relative_error = 0.0;
  double largest_relative_error = 0.0;
  double median_location_error_m = 0.0;  ///< of those found
  double largest_location_error_m = 0.0;
  double force_coverage = 0.0;     ///< share of those found that lie inside the 95 % interval
  double location_coverage = 0.0;  ///< the same of the place
  /// Of the covariances of those found (ErrorConsistency), and the range that is expected of it.
  double nees_per_degree = 0.0;
  double lowest_nees = 0.0;
  double highest_nees = 0.0;
  double within_ellipsoid = 0.0;  ///< share inside their 95 % ellipsoids
  int directions = 0;
  double mean_direction_error_rad = 0.0;  ///< where it was observable
  double largest_direction_error_rad = 0.0;
  int frames = 0;
  int false_alarms = 0;   ///< estimated forces that belong to no true one
  int failed_frames = 0;  ///< neither ok nor no_contact
};

/// Compares estimates with the truth, frame after frame.
class Accuracy {
 public:
  /// An estimated force belongs to the true one of its name; others, as long as it is no farther
  /// than this, to the nearest that is left.
  static constexpr double kFarthest_m = 0.05;

  /// True forces below `smallest_N` may be found or not and do not count.
  explicit Accuracy(double smallest_N = 0.0) : smallest_N_(smallest_N) {}

  /// The true forces from here on are other contacts, of whatever name.
  void BeginContacts() { ++contacts_begun_; }
  void Add(const std::vector<virtual_robot::TrueForce>& truth,
           const force_estimation::ForceEstimate& estimate);
  AccuracySummary Summary() const;
  const std::vector<ForceScore>& scores() const { return scores_; }

 private:
  double smallest_N_;
  std::vector<ForceScore> scores_;
  force_estimation::ErrorConsistency consistency_;
  int contacts_begun_ = 0;
  int frames_ = 0;
  int false_alarms_ = 0;
  int failed_frames_ = 0;
};

double Largest(const std::vector<double>& values);  ///< NaN: none

}  // namespace palpate::test_support
