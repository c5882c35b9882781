// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "components/force_estimation/force_estimate.hpp"

namespace palpate::force_estimation {

/// What a log says about forces: a line for each interval in which there is one, and a line when
/// one ends. Time is an argument, s of any clock.
class ForceLines {
 public:
  /// `now_s`: begin of the first interval.
  explicit ForceLines(double now_s) : taken_s_(now_s) {}

  void Add(const ForceEstimate& estimate);

  /// The lines of the interval since the last call: "forces: ball 0.521 +- 0.040 N at (12, 5, 80)
  /// mm in 29 of 30 frames; 29.8 frames/s", values of the last frame, and "force 'ball' ended after
  /// 12.3 s, at most 0.544 N". A force ends where none of the frames that may be used has it.
  std::vector<std::string> Take(double now_s);

 private:
  struct Force {
    ContactForce last;
    int frames = 0;  ///< of this interval that have it
    double begin_s = 0.0;
    double largest_N = 0.0;
  };

  std::string Summary(double interval_s) const;

  double taken_s_;
  int frames_ = 0;  ///< of this interval
  int usable_frames_ = 0;
  std::map<std::string, Force> forces_;  ///< that have not ended, by name
};

}  // namespace palpate::force_estimation
