// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/effects.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::virtual_robot {

void CheckKnown(const Effects& effects) {
  for (const scenario::ActiveEffect& effect : effects) {
    if (scenario::FindEffect(effect.id) == nullptr) {
      throw InputError("the virtual robot has no effect '" + effect.id + "'");
    }
  }
}

std::vector<const scenario::ActiveEffect*> OfKind(const Effects& effects, std::string_view id) {
  std::vector<const scenario::ActiveEffect*> found;
  for (const scenario::ActiveEffect& effect : effects) {
    if (effect.id == id) found.push_back(&effect);
  }
  return found;
}

double Value(const scenario::ActiveEffect& effect, std::string_view parameter) {
  const auto found = effect.parameters.find(std::string(parameter));
  if (found == effect.parameters.end()) {
    throw InputError("effect " + effect.id + ": no value for " + std::string(parameter));
  }
  if (!std::isfinite(found->second)) {
    throw InputError("effect " + effect.id + ": " + found->first + " is not a finite number");
  }
  return found->second;
}

Eigen::Vector3d Values(const scenario::ActiveEffect& effect, std::string_view x, std::string_view y,
                       std::string_view z) {
  return {Value(effect, x), Value(effect, y), Value(effect, z)};
}

double PositiveValue(const scenario::ActiveEffect& effect, std::string_view parameter) {
  const double value = Value(effect, parameter);
  if (!(value > 0.0)) {
    throw InputError("effect " + effect.id + ": " + std::string(parameter) + " = " +
                     FormatNumber(value) + "; it must be greater than 0");
  }
  return value;
}

double NonNegativeValue(const scenario::ActiveEffect& effect, std::string_view parameter) {
  const double value = Value(effect, parameter);
  if (!(value >= 0.0)) {
    throw InputError("effect " + effect.id + ": " + std::string(parameter) + " = " +
                     FormatNumber(value) + "; it must not be negative");
  }
  return value;
}

std::vector<int> PlacesOf(const scenario::ActiveEffect& effect, std::string_view kind,
                          const std::vector<std::string>& names, size_t count) {
  std::vector<int> places;
  const std::string prefix = std::string(kind) + ":";
  for (const std::string& where : effect.where) {
    const auto named = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return where == prefix + name;
    });
    if (named == names.end()) {
      throw InputError("effect " + effect.id + ": the robot has no '" + where + "'; expected is " +
                       prefix + "NAME of the robot file");
    }
    places.push_back(static_cast<int>(named - names.begin()));
  }
  if (places.size() != count) {
    throw InputError("effect " + effect.id + ": " + std::to_string(places.size()) +
                     " places are named, expected is " + std::to_string(count));
  }
  return places;
}

int PlaceOf(const scenario::ActiveEffect& effect, std::string_view kind,
            const std::vector<std::string>& names) {
  return PlacesOf(effect, kind, names, 1).front();
}

}  // namespace palpate::virtual_robot
