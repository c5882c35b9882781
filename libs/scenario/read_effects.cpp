// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "libs/core/text.hpp"
#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

using Where = std::vector<std::string>;

std::string ReadId(const ConfigNode& node) {
  std::vector<std::string> ids;
  for (const EffectKind& kind : EffectCatalogue()) ids.emplace_back(kind.id);
  const std::string id = ReadText(node);
  if (id == "discretisation") {
    Refuse(node, "is always there: the bench has a mesh of its own (body.refine, body.element)");
  }
  if (FindEffect(id) == nullptr) {
    Refuse(node, "there is no effect '" + id + "'" + DidYouMean(id, ids));
  }
  return id;
}

Where ReadNames(const ConfigNode& node) {
  Where names;
  if (node.kind == ConfigNode::Kind::kList) {
    for (const ConfigNode& item : node.items) names.push_back(ReadText(item));
  } else {
    names.push_back(ReadText(node));
  }
  return names;
}

/// "cable:" of "cable:<name>"; all of "body".
std::string PrefixOf(Place place) {
  if (place == Place::kTwoCables) return PrefixOf(Place::kCable);
  if (place == Place::kTwoChambers) return PrefixOf(Place::kChamber);
  const std::string pattern = DescribePlace(place);
  return pattern.substr(0, pattern.find('<'));
}

Where ReadPlace(const ConfigNode& node, const EffectKind& kind) {
  const Where names = ReadNames(node);
  const std::string prefix = PrefixOf(kind.place);
  const std::size_t count = IsOfTwo(kind.place) ? 2 : 1;
  const bool named = prefix.ends_with(':');
  const bool fits = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return named ? name.starts_with(prefix) && name.size() > prefix.size() : name == prefix;
  });
  if (!fits || names.size() != count || (count == 2 && names[0] == names[1])) {
    Refuse(node, "is " + DescribePlace(kind.place) + " for " + std::string(kind.id));
  }
  return names;
}

std::array<double, 2> ReadRange(const ConfigNode& node, const EffectParameter& parameter) {
  const NumberRule rule{.min = parameter.min, .max = parameter.max};
  std::array<double, 2> range{};
  if (node.kind == ConfigNode::Kind::kList) {
    const std::vector<double> ends = ReadNumbers(node, rule);
    if (ends.size() != 2 || ends[0] > ends[1]) {
      Refuse(node, "must be a number or a range [lower, upper] to draw from");
    }
    range = {ends[0], ends[1]};
  } else {
    range.fill(ReadNumber(node, rule));
  }
  const bool whole = range[0] == std::floor(range[0]) && range[1] == std::floor(range[1]);
  if (parameter.whole && !whole) Refuse(node, "must be a whole number");
  return range;
}

void ReadParameters(const ConfigNode& node, MapReader& reader, const EffectKind& kind,
                    Effect* effect) {
  for (const EffectParameter& parameter : kind.parameters) {
    const std::string name(parameter.name);
    const ConfigNode* entry = parameter.required ? &reader.Require(name) : reader.Optional(name);
    if (entry != nullptr) effect->ranges[name] = ReadRange(*entry, parameter);
  }
  if (!kind.parameters.empty() && effect->ranges.empty()) {
    Refuse(node, "an effect without a size: give at least one of its parameters");
  }
}

/// The normal of a hidden obstacle must be able to point somewhere.
void CheckNormal(const ConfigNode& node, const Effect& effect) {
  if (effect.id != "hidden_obstacle") return;
  for (const char* name : {"nx", "ny", "nz"}) {
    const auto& [low, high] = effect.ranges.at(name);
    if (low > 0.0 || high < 0.0 || (low == high && low != 0.0)) return;
  }
  Refuse(node, "the normal (nx, ny, nz) must not be able to be zero");
}

Effect ReadEffect(const ConfigNode& node) {
  Effect effect;
  effect.location = node.where;
  effect.id = ReadId(MapReader(node).Require("id"));
  const EffectKind& kind = *FindEffect(effect.id);
  MapReader reader(node, EffectKeys(kind));
  reader.Require("id");
  if (const ConfigNode* where = reader.Optional("where")) effect.where = ReadPlace(*where, kind);
  ReadParameters(node, reader, kind, &effect);
  reader.Finish();
  CheckNormal(node, effect);
  return effect;
}

}  // namespace

std::vector<Effect> ReadEffects(const ConfigNode& node) {
  std::vector<Effect> effects;
  for (const ConfigNode& item : ReadList(node, "effects")) {
    Effect effect = ReadEffect(item);
    const EffectKind& kind = *FindEffect(effect.id);
    for (const Effect& other : effects) {
      if (other.id == effect.id && !effect.where.empty() &&
          SamePlace(kind, other.where, effect.where)) {
        Refuse(item, "a second '" + effect.id + "' at the same place");
      }
    }
    effects.push_back(std::move(effect));
  }
  return effects;
}

}  // namespace palpate::scenario
