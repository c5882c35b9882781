// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/robot/robot_description.hpp"
#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/generator.hpp"
#include "tests/system/blind/verdict.hpp"

namespace palpate::blind {

/// What became of one case.
struct CaseRecord {
  std::uint64_t seed = 0;
  CaseKind kind = CaseKind::kHealthy;
  Corruption corruption = Corruption::kNone;
  std::vector<scenario::ActiveEffect> truth = {};  ///< of the opened answer
  std::vector<double> sizes_m = {};                ///< of each of them, Generator::EffectSizes_m
  std::string not_made = {};  ///< why the virtual robot could not do it; empty: it was made
  std::optional<Verdict> verdict = {};
  std::string no_verdict = {};  ///< why there is none
  double diagnosis_s = 0.0;     ///< by the clock
};

/// Runs single cases, from the drawing to the opened answer, in a folder of its own. Several may
/// run at a time.
class CaseRunner {
 public:
  struct Settings {
    std::filesystem::path robot_file;
    std::filesystem::path folder;  ///< is there
    bool keep = false;             ///< what a case leaves in it
    Measured measured = Measured::kMarkers;
    int longest_diagnosis_s = 1200;
    int samples = 120;  ///< `palpate diagnose --samples`
    int minutes = 5;    ///< `palpate diagnose --minutes`
  };

  explicit CaseRunner(Settings settings);

  /// The diagnosis gets a copy of the experiment under a name that says nothing, the robot file and
  /// what it is to withhold; scenario and answer lie elsewhere, and the answer is opened once the
  /// verdict is there. Throws RunError where the seal is broken or files cannot be written.
  CaseRecord Run(std::uint64_t seed) const;

 private:
  void Diagnose(const BlindCase& drawn, const std::filesystem::path& data,
                const std::filesystem::path& out, CaseRecord* record) const;

  Settings settings_;
  robot::RobotDescription robot_;
  mutable std::atomic<int> cases_ = 0;
};

}  // namespace palpate::blind
