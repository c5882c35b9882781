// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/key_table.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"

namespace palpate {

namespace {

using ValueKind = ValueType::Kind;

struct Unit {
  std::string_view suffix;   // of a key
  std::string_view written;  // for people
};

// Longest first, so that "density_kg_m3" ends in "kg_m3" and not in "m3".
constexpr std::array<Unit, 23> kMixedUpUnits{{
    {"kg_m3", "kg/m³"}, {"g_cm3", "g/cm³"}, {"mm_s2", "mm/s²"}, {"cm_s2", "cm/s²"},
    {"m_s2", "m/s²"},   {"kPa", "kPa"},     {"MPa", "MPa"},     {"GPa", "GPa"},
    {"deg", "deg"},     {"rad", "rad"},     {"Pa", "Pa"},       {"mm", "mm"},
    {"cm", "cm"},       {"um", "µm"},       {"km", "km"},       {"kg", "kg"},
    {"mg", "mg"},       {"mN", "mN"},       {"kN", "kN"},       {"in", "in"},
    {"m", "m"},         {"g", "g"},         {"N", "N"},
}};
// No file has these in another unit.
constexpr std::array<Unit, 8> kOtherUnits{{
    {"rad_Nm", "rad/(N m)"},
    {"rad_m", "rad/m"},
    {"m_N", "m/N"},
    {"N_m", "N/m"},
    {"1_s", "1/s"},
    {"hz", "Hz"},
    {"px", "px"},
    {"s", "s"},
}};

/// "path_mm" -> "path" and the unit mm; no unit where the key does not end in one.
struct SplitKey {
  std::string_view quantity;
  std::string_view suffix;
  std::string_view written;
};

template <typename Units>
SplitKey Split(std::string_view key, const Units& units) {
  for (const Unit& unit : units) {
    const size_t tail = unit.suffix.size() + 1;
    if (key.size() > tail && key.ends_with(unit.suffix) && key[key.size() - tail] == '_') {
      return {key.substr(0, key.size() - tail), unit.suffix, unit.written};
    }
  }
  return {key, {}, {}};
}

ValueType Numeric(ValueKind kind, const NumberRule& rule) {
  ValueType type;
  type.kind = kind;
  type.rule = rule;
  return type;
}

}  // namespace

namespace value {

ValueType Boolean() { return {.kind = ValueKind::kBoolean}; }

ValueType WholeNumber(int min, int max) {
  return Numeric(ValueKind::kInteger,
                 {.min = static_cast<double>(min), .max = static_cast<double>(max)});
}

ValueType Real(const NumberRule& rule) { return Numeric(ValueKind::kNumber, rule); }

ValueType Text() { return {}; }

ValueType Choice(std::vector<std::string> choices) {
  ValueType type;
  type.choices = std::move(choices);
  return type;
}

ValueType File() { return {.kind = ValueKind::kFile}; }

ValueType Vector3(const NumberRule& rule) { return Numbers(rule, 3, 3); }

ValueType Numbers(const NumberRule& rule, int min_items, int max_items) {
  ValueType type = List(Real(rule), min_items);
  type.max_items = max_items;
  return type;
}

ValueType Points(int min_items, int max_items) {
  ValueType type = List(Vector3(), min_items);
  type.max_items = max_items;
  return type;
}

ValueType List(ValueType item, int min_items) {
  ValueType type;
  type.kind = ValueKind::kList;
  type.parts.push_back(std::move(item));
  type.min_items = min_items;
  return type;
}

ValueType Map(const KeyTable& keys) {
  ValueType type;
  type.kind = ValueKind::kMap;
  type.keys = &keys;
  return type;
}

ValueType ListOfMaps(const KeyTable& keys, int min_items) { return List(Map(keys), min_items); }

ValueType Either(std::vector<ValueType> alternatives) {
  ValueType type;
  type.kind = ValueKind::kEither;
  type.parts = std::move(alternatives);
  return type;
}

ValueType OrNull(ValueType type) {
  type.may_be_null = true;
  return type;
}

}  // namespace value

const Presence kRequired{.kind = Presence::Kind::kRequired, .text = "required", .json = {}};
const Presence kOptional{};

Presence RequiredFor(const std::string& condition) {
  return {Presence::Kind::kRequiredIf, "required for " + condition, {}};
}

Presence OnlyFor(const std::string& condition) {
  return {Presence::Kind::kOptionalIf, "only for " + condition, {}};
}

Presence OnlyFor(const std::string& condition, Presence with_default) {
  with_default.kind = Presence::Kind::kOptionalIf;
  with_default.text += ", only for " + condition;
  return with_default;
}

Presence Default(double value) {
  const std::string text = FormatNumber(value);
  return {Presence::Kind::kOptional, text, text};
}

Presence Default(int value) { return Default(static_cast<double>(value)); }

Presence Default(bool value) {
  const std::string text = value ? "true" : "false";
  return {Presence::Kind::kOptional, text, text};
}

Presence Default(const char* word) { return {Presence::Kind::kOptional, word, Quoted(word)}; }

Presence Default(const Eigen::VectorXd& vector) {
  std::string text;
  for (const double number : vector) text += (text.empty() ? "" : ", ") + FormatNumber(number);
  return {Presence::Kind::kOptional, "[" + text + "]", "[" + text + "]"};
}

const Key* KeyTable::Find(std::string_view name) const {
  for (const Key& key : keys) {
    if (key.name == name) return &key;
  }
  for (const Key& key : open_keys) {
    const std::string_view tail = std::string_view(key.name).substr(key.name.rfind('>') + 1);
    if (name.size() > tail.size() && name.ends_with(tail)) return &key;
  }
  return nullptr;
}

std::string UnitOf(std::string_view key) {
  const SplitKey other = Split(key, kOtherUnits);
  return std::string(other.suffix.empty() ? Split(key, kMixedUpUnits).written : other.written);
}

void RefuseForeignUnits(const ConfigNode& map, const KeyTable& keys) {
  for (const auto& [name, entry] : map.entries) {
    if (keys.Find(name) != nullptr) continue;
    const SplitKey written = Split(name, kMixedUpUnits);
    for (const Key& key : keys.keys) {
      const SplitKey known = Split(key.name, kMixedUpUnits);
      if (known.suffix.empty() || known.quantity != written.quantity) continue;
      Refuse(entry, written.suffix.empty() ? "the unit is missing: write '" + key.name + "'"
                                           : "the unit '" + std::string(written.suffix) +
                                                 "' does not fit: write '" + key.name + "'");
    }
  }
}

}  // namespace palpate
