// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/unit_keys.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "libs/core/config_reader.hpp"

namespace palpate::robot {

namespace {

/// Longest first, so that "density_kg_m3" ends in "kg_m3" and not in "m3".
constexpr std::array<std::string_view, 23> kUnits{
    "kg_m3", "g_cm3", "mm_s2", "cm_s2", "m_s2", "kPa", "MPa", "GPa", "deg", "rad", "Pa", "mm",
    "cm",    "um",    "km",    "kg",    "mg",   "mN",  "kN",  "in",  "m",   "g",   "N"};

/// "path_mm" -> "path" and "mm"; no unit where the key does not end in one.
struct SplitKey {
  std::string_view quantity;
  std::string_view unit;
};

SplitKey Split(std::string_view key) {
  for (const std::string_view unit : kUnits) {
    if (key.size() > unit.size() + 1 && key.ends_with(unit) &&
        key[key.size() - unit.size() - 1] == '_') {
      return {key.substr(0, key.size() - unit.size() - 1), unit};
    }
  }
  return {key, {}};
}

}  // namespace

void RefuseForeignUnits(const ConfigNode& map, const std::vector<std::string>& keys) {
  for (const auto& [name, entry] : map.entries) {
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
    const SplitKey written = Split(name);
    for (const std::string& key : keys) {
      const SplitKey known = Split(key);
      if (known.quantity != written.quantity) continue;
      Refuse(entry, written.unit.empty() ? "the unit is missing: write '" + key + "'"
                                         : "the unit '" + std::string(written.unit) +
                                               "' does not fit: write '" + key + "'");
    }
  }
}

}  // namespace palpate::robot
