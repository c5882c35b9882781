// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "libs/robot/robot_description.hpp"
#include "libs/scenario/effect.hpp"
#include "libs/scenario/random.hpp"

namespace palpate::blind {

using Parameters = std::map<std::string, double>;

/// A cause that the blind tests hide, and how large.
struct MenuItem {
  std::string_view id;
  /// Within the fault range of the catalogue (components/diagnosis/faults). Sizes are uniform in
  /// the logarithm, so that small ones are as frequent as large ones.
  Parameters (*draw)(scenario::Random* random, const robot::RobotDescription& robot);
};

/// Those that move four_leg's markers in config/scenarios/diagnose.yaml by 0.3 mm RMS in some
/// recording, at least at the upper end of their range.
const std::vector<MenuItem>& CauseMenu();
/// Those of chambers, by the same rule for pneumatic_finger and pneumatic_arm.
const std::vector<MenuItem>& ChamberMenu();
/// Those of robots whose cables run through eyelets: without the obstacle, with friction.
const std::vector<MenuItem>& EyeletMenu();
/// What can be hidden in a robot: of one with chambers those of its chambers.
std::vector<MenuItem> MenuFor(const robot::RobotDescription& robot);

struct LeftOut {
  std::string_view id;
  std::string_view why;
};

/// The rest of the catalogue, on robots without chambers.
const std::vector<LeftOut>& LeftOutOfMenu();

/// What else does exactly the same to this robot: either name is right.
std::vector<std::string> TwinsOf(const scenario::ActiveEffect& effect);

/// Twins, and what it is a special case of, as a mass is of a force: these do all that it does, and
/// whoever withholds it withholds them, too.
std::vector<std::string> CoveredBy(const scenario::ActiveEffect& effect);

}  // namespace palpate::blind
