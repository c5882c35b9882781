// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/palpate/compare/comparison_summary.hpp"
#include "components/palpate/compare/force_file.hpp"

namespace palpate::command {

/// How two force files are compared.
struct FileComparisonRules {
  std::vector<std::string> recordings;  ///< names; empty: all that both files have
  double time_offset_s = 0.0;           ///< added to the times of the estimate
  TruthTiming timing = {};              ///< `holds` follows from the file
  /// Times of the truth without a row of the estimate within timing.longest_gap_s are frames in
  /// which it found nothing; else nothing is known of them.
  bool silence_is_no_contact = false;
  double same_place_m = ComparisonRules().same_place_m;
  std::optional<double> smallest_N;  ///< nullopt: a tenth of the largest true force (RulesOf)
};

/// One recording that both files have.
struct RecordingScore {
  std::string name;       ///< empty where neither file names it
  int frames = 0;         ///< of the estimate
  int without_truth = 0;  ///< of those with a result: the truth of their time is not known
  int without_result = 0;
  ComparisonSummary summary;
};

struct FileComparison {
  ComparisonRules rules;
  std::vector<RecordingScore> recordings;
  ComparisonSummary all;
  std::vector<std::string> notes;  ///< what was left out, a sentence without a full stop each
};

/// Compares frame by frame, as `palpate estimate --answer` does. Throws InputError where no
/// recording is in both, or a name is not known, and RunError where no time is.
FileComparison CompareForces(const ForceFile& estimated, const ForceFile& truth,
                             const FileComparisonRules& rules);

}  // namespace palpate::command
