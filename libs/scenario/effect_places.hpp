// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/scenario/effect.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::scenario {

/// Whether `where` names two actuators.
bool IsOfTwo(Place place);

/// How `where` is written for effects of this kind: "cable:<name>", "body", ...
std::string DescribePlace(Place place);

/// Every `where` that an effect of this kind can have on the robot, in the order of its names. Two
/// cables or tubes that are swapped have no order, those of drive_coupling have.
std::vector<std::vector<std::string>> PlacesOn(const EffectKind& kind, const RobotNames& robot);

/// Whether two effects of this kind would be at the same place.
bool SamePlace(const EffectKind& kind, const std::vector<std::string>& a,
               const std::vector<std::string>& b);

}  // namespace palpate::scenario
