// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::scenario {

/// Which part of the bench an effect changes.
enum class Side { kBody, kBase, kActuator, kCamera };

/// Parts of the robot that `where` can name.
enum class Place {
  kBody,
  kBase,
  kCamera,
  kRegion,
  kCable,
  kTwoCables,
  kChamber,
  kTwoChambers,
  kMarker
};

/// One parameter of an effect, with the name and unit of verdict.json.
struct EffectParameter {
  std::string_view name;   ///< "mu"
  double healthy = 0.0;    ///< value without the effect; NaN: the robot file's
  double tolerance = 0.0;  ///< manufacturing tolerance, one standard deviation; 0: none
  double min = 0.0;        ///< values allowed in a scenario
  double max = 0.0;
  bool required = true;  ///< else `healthy` where it is left out
  bool whole = false;    ///< an integer
};

/// One row of the catalogue of effects (README.md here; causes: docs/diagnosis.md).
struct EffectKind {
  std::string_view id;
  Side side;
  Place place;
  std::vector<EffectParameter> parameters;
  std::string_view what;  ///< one line for people
};

/// The whole catalogue. `discretisation` is no entry: the bench's own
/// mesh always is one.
const std::vector<EffectKind>& EffectCatalogue();
/// nullptr where there is none of that id.
const EffectKind* FindEffect(std::string_view id);

/// An effect as the scenario file asks for it: each parameter a value, or a range that the seed
/// draws from (uniformly; a range that does not hold zero and spans more than a decade:
/// logarithmically). An empty `where` is drawn too.
struct Effect {
  std::string id;
  std::vector<std::string> where;  ///< "cable:north", "region:leg_north", "marker:tip", "body", ...
  std::map<std::string, std::array<double, 2>> ranges;  ///< lower <= upper
  SourceLocation location;
};

/// An effect of the bench: part of the ground truth.
struct ActiveEffect {
  std::string id;
  std::vector<std::string> where;
  std::map<std::string, double> parameters;  ///< every one of the kind's
  bool clutter = false;                      ///< a manufacturing tolerance, not a fault

  double Get(std::string_view parameter) const;
};

struct Scenario;
struct RobotNames;

/// Draws the scenario's effects and manufacturing tolerances; the result depends on the arguments
/// only, not on the machine. Effects of the scenario come first.
std::vector<ActiveEffect> DrawEffects(const Scenario& scenario, const RobotNames& robot,
                                      std::uint64_t seed);

}  // namespace palpate::scenario
