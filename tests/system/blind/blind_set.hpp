// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/system/blind/case_runner.hpp"

namespace palpate::blind {

/// Which cases. From the environment: PALPATE_BLIND_CASES (1 to 100000), PALPATE_BLIND_SEED (of the
/// first case, 0 to 2000000000; the next case has the next seed), PALPATE_BLIND_KIND (healthy, one
/// cause, two causes, outside, corrupted: the next seeds of this kind alone), PALPATE_BLIND_CAUSE
/// (one of the menu: the next seeds that hide it alone; `each`: as many of every one),
/// PALPATE_BLIND_ROBOT (four_leg, rod, pneumatic_finger, pneumatic_arm; `each`: as many of every
/// one), PALPATE_BLIND_FOLDER (everything is kept there; without it nothing is),
/// PALPATE_BLIND_DATA (markers, or pictures), PALPATE_BLIND_SAMPLES (10 to 2000).
struct BlindSet {
  int cases = 0;
  std::uint64_t seed = 0;
  std::filesystem::path folder = {};  ///< empty: a temporary one
  int samples = 120;                  ///< moments that diagnosis compares, at most
  int minutes = 10;                   ///< after which it looks for no further cause
  Measured measured = Measured::kMarkers;
  std::optional<CaseKind> kind = {};  ///< none: all, in their mix
  std::string cause = {};             ///< empty: all, in their mix; `each`: `cases` of every one
  std::string robot = "four_leg";     ///< `each`: `cases` of every one

  /// `cases`: where the environment does not say; the seed then is a fresh one. Throws InputError
  /// for what is none of this.
  static BlindSet FromEnvironment(int cases);

  /// One for each robot.
  std::vector<BlindSet> OfRobots() const;
  /// Of all cases of one robot. Throws InputError for a cause that the menu of `diagnosed` has not.
  std::vector<std::uint64_t> Seeds(const robot::RobotDescription& diagnosed) const;
};

/// Runs them, two at a time, through processes: palpate simulate, palpate diagnose. Prints the
/// seed, a line for each case as it ends, and the table, robot by robot. Throws RunError where a
/// seal is broken.
std::vector<CaseRecord> RunBlind(const BlindSet& set, std::ostream& out);

}  // namespace palpate::blind
