// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "libs/robot/robot_description.hpp"
#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/case_record.hpp"
#include "tests/system/blind/generator.hpp"

namespace palpate::blind {

/// Runs single cases, from the drawing to the opened answer, in a folder of its own. Several may
/// run at a time.
class CaseRunner {
 public:
  struct Settings {
    std::filesystem::path robot_file;
    std::filesystem::path folder;  ///< is there
    bool keep = false;             ///< what a case leaves in it, and take what one has left
    Measured measured = Measured::kMarkers;
    int longest_diagnosis_s = 1200;
    int samples = 120;  ///< `palpate diagnose --samples`
    int minutes = 10;   ///< `palpate diagnose --minutes`
  };

  explicit CaseRunner(Settings settings);

  /// The diagnosis gets a copy of the experiment under a name that says nothing, the robot file and
  /// what it is to withhold; scenario and answer lie elsewhere, and the answer is opened once the
  /// verdict is there. Throws RunError where the seal is broken or files cannot be written.
  CaseRecord Run(std::uint64_t seed) const;

 private:
  std::filesystem::path Sealed(std::uint64_t seed) const {
    return settings_.folder / ("sealed" + std::to_string(seed));
  }
  std::filesystem::path Open(std::uint64_t seed) const {
    return settings_.folder / ("open" + std::to_string(seed));
  }
  std::string HowAsked() const;
  bool TakeKept(const BlindCase& drawn, CaseRecord* record) const;
  void RunAnew(const BlindCase& drawn, CaseRecord* record) const;
  std::filesystem::path DiagnosedRobotFile(const BlindCase& drawn,
                                           const std::filesystem::path& folder) const;
  void Diagnose(const BlindCase& drawn, const std::filesystem::path& data,
                const std::filesystem::path& out, CaseRecord* record) const;

  Settings settings_;
  robot::RobotDescription robot_;
};

}  // namespace palpate::blind
