// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libs/robot/robot_description.hpp"
#include "libs/scenario/effect.hpp"
#include "libs/scenario/random.hpp"
#include "tests/system/blind/cause_menu.hpp"

namespace palpate::blind {

/// What the data show of the robot.
enum class Measured {
  kMarkers,
  kPictures,  ///< depth and colour images; nothing is hidden then that only markers have
};

enum class CaseKind { kHealthy, kOneCause, kTwoCauses, kOutside, kCorrupted };

/// How data are spoilt that no cause may be read from.
enum class Corruption {
  kNone,
  kShuffledStamps,    ///< of one recording's markers
  kFrozenMarkers,     ///< they stand still from some moment of a recording on
  kNotANumber,        ///< some coordinates of a recording are words
  kMissingActuation,  ///< of one recording that others have
  kOtherRobot,        ///< the data are right, the robot file is another's
};

/// What is hidden in one experiment. Follows from the seed alone, and is never shown to whoever
/// diagnoses.
struct BlindCase {
  std::uint64_t seed = 0;  ///< also of noise and clutter
  CaseKind kind = CaseKind::kHealthy;
  std::vector<scenario::ActiveEffect> effects =
      {};                                 ///< wanted ones; clutter is drawn by `simulate`
  std::vector<std::string> without = {};  ///< catalogue entries that are withheld
  Corruption corruption = Corruption::kNone;
};

/// One of the menu, at any of its places on the robot.
scenario::ActiveEffect DrawEffect(const MenuItem& item, const robot::RobotDescription& robot,
                                  scenario::Random* random);

/// Any 20 seeds in a row: 5 healthy, 9 with one cause, 3 with two, 2 with one outside of the
/// catalogue, 1 of corrupted data.
CaseKind KindOf(std::uint64_t seed);

/// Two causes are of different kinds.
BlindCase DrawCase(std::uint64_t seed, const robot::RobotDescription& robot,
                   Measured measured = Measured::kMarkers);

std::string ToString(CaseKind kind);
std::string ToString(Corruption corruption);
/// "cable_gain [cable:north] g 0.09"
std::string Describe(const scenario::ActiveEffect& effect);

}  // namespace palpate::blind
