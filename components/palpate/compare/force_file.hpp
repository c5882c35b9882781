// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "components/force_estimation/force_estimate.hpp"
#include "components/palpate/compare/truth_timeline.hpp"

namespace palpate::command {

/// The forces of a file, frame by frame.
struct ForceFile {
  enum class Kind {
    kTable,   ///< forces.csv, or another table with its columns
    kLoads,   ///< loads.csv: places on the undeformed body, a row holds until the next
    kAnswer,  ///< EXP.answer.json of `palpate simulate`
  };

  Kind kind = Kind::kTable;
  /// By recording, in rising time; of a file that names no recordings "" is the only one. What the
  /// file does not say is NaN.
  std::map<std::string, std::vector<force_estimation::ForceEstimate>> of_recording;
  std::vector<std::string> unused_columns;
  bool has_frames_without_contact = false;
};

/// Reads any of the three kinds: JSON is kAnswer, and a CSV with no other columns than those of
/// loads.csv kLoads. Throws InputError with file:line:column.
ForceFile ReadForceFile(const std::filesystem::path& file);

/// The same of kAnswer alone.
ForceFile ReadAnswerForces(const std::filesystem::path& answer);

/// The frames as a truth; those without a result are no samples. Of kLoads, and of a recording with
/// a single time, samples hold.
TruthTimeline TruthOf(const ForceFile& file, const std::string& recording, TruthTiming timing);

}  // namespace palpate::command
