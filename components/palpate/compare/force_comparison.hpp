// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/offline/forces/has_force.hpp"
#include "components/palpate/compare/truth_timeline.hpp"

namespace palpate::command {

/// Tuning of the comparison: which contacts are the same, and which have to be detected.
struct ComparisonRules {
  double same_place_m = 0.04;    ///< an estimate farther from every true force is a false alarm
  double smallest_N = 0.1;       ///< true forces below may be missed
  double steady_window_s = 0.3;  ///< a force is steady where it varied for so long
  double steady_share = 0.05;    ///< by no more than this share
};

/// The rules that follow from the truth, by recording, so that the comparison is the same for
/// robots of any strength: forces of a tenth of the largest one or more must be detected while they
/// are steady. Where samples are rare, steadiness is not asked for.
ComparisonRules RulesOf(const std::map<std::string, TruthTimeline>& truth, double same_place_m);
/// Size from which on forces must be detected where this is the largest one.
double SmallestForce_N(double largest_N);

/// A true force, its estimate, or both, in one frame. Without truth: a false alarm;
/// without estimate: a miss, where it is `due`.
struct ComparedForce {
  double t_s = 0.0;
  std::string recording = {};  ///< contacts of one name in different ones are different
  std::optional<TrueContact> truth;
  std::optional<force_estimation::ContactForce> estimate;
  bool due = false;     ///< steady, and large enough to be detected
  int true_forces = 0;  ///< that act in this frame, large enough to be detected
};

/// Matches the contacts of a frame with the true forces of its time, each with the nearest that is
/// left, near pairs first. Frames without a result (neither ok nor no_contact), or whose truth is
/// not known, give nothing.
std::vector<ComparedForce> CompareFrame(const force_estimation::ForceEstimate& estimate,
                                        const TruthTimeline& truth, const ComparisonRules& rules);

/// The contacts of a frame whose forces have a number, without a truth.
std::vector<ComparedForce> WithoutTruth(const force_estimation::ForceEstimate& estimate);

/// Whether the frame has a result: forces, or that there is none.
bool HasResult(const Status& status);

using offline::HasForce;

/// |F| of the estimate minus |F| of the truth, N; where only the normal component is observable,
/// minus the truth's component along the normal. Needs both.
double ForceError_N(const ComparedForce& force);

}  // namespace palpate::command
