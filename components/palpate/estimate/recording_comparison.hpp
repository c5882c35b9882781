// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/force_estimation/force_estimate.hpp"
#include "components/palpate/compare/comparison_summary.hpp"
#include "components/palpate/compare/force_tracks.hpp"
#include "components/palpate/estimate/known_truth.hpp"

namespace palpate::command {

/// The estimates of one recording: as curves over time, and against the truth where it is known.
class RecordingComparison {
 public:
  /// `truth`, which must outlive it: nullptr where none is known, or none of this recording.
  RecordingComparison(std::string recording, const KnownTruth* truth);

  /// `all`: a summary over several recordings that the frame counts in, too.
  void Add(const force_estimation::ForceEstimate& estimate, ComparisonSummary* all);

  bool has_truth() const { return timeline_ != nullptr; }
  const ComparisonSummary& summary() const { return summary_; }
  /// Forces over time with their 95 % intervals, and the truth. Throws RunError.
  void Draw(const std::string& robot, const std::filesystem::path& file) const;

 private:
  std::string recording_;
  const KnownTruth* truth_;
  const TruthTimeline* timeline_ = nullptr;
  ComparisonSummary summary_;
  ForceTracks tracks_;
};

}  // namespace palpate::command
