// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "libs/robot/robot_description.hpp"
#include "libs/scenario/effect.hpp"
#include "tests/system/blind/verdict.hpp"

namespace palpate::blind {

/// A further recording, and what came of it.
struct PlanOutcome {
  std::string title = {};  ///< "weight of 30 g at ..."
  int rank = 0;            ///< in the ranking, 1 the best
  bool separated = false;  ///< the hidden cause is named first, and nothing fits as well
};

/// What became of one question.
struct PlanRecord {
  std::uint64_t seed = 0;
  scenario::ActiveEffect effect;  ///< that was hidden
  std::string no_question = {};   ///< why the case does not count; empty: it does
  int ranked = 0;                 ///< experiments to choose among
  PlanOutcome proposed = {};      ///< the best of the ranking
  PlanOutcome drawn = {};         ///< one of the ranking, each as likely
};

/// A cause hidden in so few recordings that others, or none, may fit them as well. Where it is not
/// named clearly, and the diagnosis has a question, once more with the recording that `palpate
/// diagnose --plan` asks for, and once with one of its ranking. The robot, its clutter and its
/// noise stay.
class PlanRunner {
 public:
  struct Settings {
    std::filesystem::path robot_file;
    std::filesystem::path folder;  ///< is there; each case works in one of its own in it
    int samples = 30;              ///< `palpate diagnose --samples`
  };

  explicit PlanRunner(Settings settings);

  /// Throws RunError where files cannot be written, or a program fails.
  PlanRecord Run(std::uint64_t seed) const;

 private:
  Verdict Diagnose(const std::filesystem::path& data, const std::filesystem::path& out) const;

  Settings settings_;
  robot::RobotDescription robot_;
};

}  // namespace palpate::blind
