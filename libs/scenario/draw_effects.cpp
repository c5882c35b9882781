// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/scenario/effect.hpp"
#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/random.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::scenario {

namespace {

using Where = std::vector<std::string>;

/// Drawn numbers are kept to so many digits: their last bits would differ between machines.
constexpr int kDigits = 9;

double Rounded(double value) {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value,
                                     std::chars_format::scientific, kDigits - 1);
  double rounded = 0.0;
  std::from_chars(text.data(), written.ptr, rounded);
  return rounded;
}

/// Logarithmically where the range does not hold zero and spans more than a decade.
double Between(const std::array<double, 2>& range, bool whole, double share) {
  const auto [low, high] = range;
  if (low == high) return low;
  if (whole) return std::min(high, low + std::floor(share * (high - low + 1.0)));
  const bool logarithmic = low * high > 0.0 && std::max(high / low, low / high) > 10.0;
  const double value = logarithmic ? low * std::pow(high / low, share) : low + share * (high - low);
  return std::clamp(Rounded(value), low, high);
}

Where DrawPlace(const EffectKind& kind, const RobotNames& robot,
                const std::vector<ActiveEffect>& taken, Random* random) {
  std::vector<Where> free = PlacesOn(kind, robot);
  std::erase_if(free, [&](const Where& place) {
    return std::any_of(taken.begin(), taken.end(), [&](const ActiveEffect& other) {
      return other.id == kind.id && SamePlace(kind, other.where, place);
    });
  });
  PALPATE_CHECK(!free.empty(), kind.id);
  return free[random->Below(free.size())];
}

void DrawParameters(const Effect& effect, const EffectKind& kind, Random* random,
                    ActiveEffect* active) {
  for (const EffectParameter& parameter : kind.parameters) {
    const double share = random->Uniform();
    const std::string name(parameter.name);
    const auto range = effect.ranges.find(name);
    PALPATE_CHECK(range != effect.ranges.end() || !parameter.required, kind.id, name);
    active->parameters[name] = range == effect.ranges.end()
                                   ? parameter.healthy
                                   : Between(range->second, parameter.whole, share);
  }
}

/// Effects with `where` first, so that the places of the others are drawn from those that remain.
std::vector<ActiveEffect> DrawWanted(const Scenario& scenario, const RobotNames& robot,
                                     std::uint64_t seed) {
  std::vector<ActiveEffect> wanted(scenario.effects.size());
  for (const bool drawn : {false, true}) {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Effect& effect = scenario.effects[i];
      if (effect.where.empty() != drawn) continue;
      const EffectKind* kind = FindEffect(effect.id);
      PALPATE_CHECK(kind != nullptr, effect.id);
      Random random(seed, "effect " + std::to_string(i) + " " + effect.id);
      const Where where = drawn ? DrawPlace(*kind, robot, wanted, &random) : effect.where;
      wanted[i].id = effect.id;
      wanted[i].where = where;
      DrawParameters(effect, *kind, &random, &wanted[i]);
    }
  }
  return wanted;
}

double Nominal(const EffectParameter& parameter, const Scenario& scenario,
               const RobotNames& robot) {
  if (!std::isnan(parameter.healthy)) return parameter.healthy;
  return scenario.body.poissons_ratio.value_or(robot.poissons_ratio);
}

/// As built: normally about the nominal value, to one side where that is the end of what can be.
double AsBuilt(const EffectParameter& parameter, double nominal, double deviation) {
  if (nominal <= parameter.min) deviation = std::abs(deviation);
  if (nominal >= parameter.max) deviation = -std::abs(deviation);
  return std::clamp(Rounded(nominal + deviation), parameter.min, parameter.max);
}

/// nullopt where no parameter has a tolerance, or its nominal value is unknown.
std::optional<ActiveEffect> DrawClutter(const EffectKind& kind, const Where& where,
                                        const Scenario& scenario, const RobotNames& robot,
                                        std::uint64_t seed) {
  std::string stream = "clutter " + std::string(kind.id);
  for (const std::string& name : where) stream += " " + name;
  Random random(seed, stream);
  ActiveEffect active{
      .id = std::string(kind.id), .where = where, .parameters = {}, .clutter = true};
  bool any = false;
  for (const EffectParameter& parameter : kind.parameters) {
    const double nominal = Nominal(parameter, scenario, robot);
    const double normal = random.Normal();
    if (std::isnan(nominal)) return std::nullopt;
    any = any || parameter.tolerance > 0.0;
    active.parameters[std::string(parameter.name)] =
        parameter.tolerance > 0.0
            ? AsBuilt(parameter, nominal, scenario.clutter * parameter.tolerance * normal)
            : nominal;
  }
  if (!any) return std::nullopt;
  return active;
}

bool HasPart(const Scenario& scenario, const EffectKind& kind) {
  if (kind.side == Side::kCamera) return scenario.camera.has_value();
  return kind.place != Place::kMarker || scenario.markers.has_value();
}

}  // namespace

std::vector<ActiveEffect> DrawEffects(const Scenario& scenario, const RobotNames& robot,
                                      std::uint64_t seed) {
  CheckAgainst(scenario, robot);
  std::vector<ActiveEffect> effects = DrawWanted(scenario, robot, seed);
  if (scenario.clutter == 0.0) return effects;
  const std::vector<ActiveEffect> wanted = effects;
  for (const EffectKind& kind : EffectCatalogue()) {
    if (!HasPart(scenario, kind)) continue;
    for (const Where& where : PlacesOn(kind, robot)) {
      const bool is_wanted =
          std::any_of(wanted.begin(), wanted.end(), [&](const ActiveEffect& effect) {
            return effect.id == kind.id && SamePlace(kind, effect.where, where);
          });
      if (is_wanted) continue;
      if (auto clutter = DrawClutter(kind, where, scenario, robot, seed)) {
        effects.push_back(std::move(*clutter));
      }
    }
  }
  return effects;
}

}  // namespace palpate::scenario
