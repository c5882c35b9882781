// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/feature.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"

namespace palpate::gige_vision {

Feature::Feature(Kind its_kind, std::string its_category, std::string its_name)
    : kind{its_kind}, category{std::move(its_category)}, name{std::move(its_name)} {
  if (kind == Kind::kFloat) size = 8;
  if (kind == Kind::kCommand) writable = true;
}

Feature&& Feature::Value(double value) && {
  values = {value};
  return std::move(*this);
}

Feature&& Feature::Values(std::vector<double> its_values) && {
  values = std::move(its_values);
  return std::move(*this);
}

Feature&& Feature::Range(double least, double greatest, double step) && {
  ranged = true;
  min = least;
  max = greatest;
  increment = step;
  return std::move(*this);
}

Feature&& Feature::Entries(std::vector<std::pair<std::string, std::uint32_t>> its_entries) && {
  entries = std::move(its_entries);
  return std::move(*this);
}

Feature&& Feature::SelectedBy(std::string its_selector, std::vector<std::size_t> its_slots) && {
  selector = std::move(its_selector);
  slots = std::move(its_slots);
  return std::move(*this);
}

Feature&& Feature::At(std::uint32_t its_address, std::size_t its_size) && {
  bootstrap = true;
  address = its_address;
  size = its_size;
  return std::move(*this);
}

Feature&& Feature::Bits(int lowest, int highest) && {
  lowest_bit = lowest;
  highest_bit = highest;
  return std::move(*this);
}

Feature&& Feature::Command(std::uint32_t written) && {
  command_value = written;
  return std::move(*this);
}

Feature&& Feature::Writable() && {
  writable = true;
  return std::move(*this);
}

Feature&& Feature::Locked() && {
  writable = true;
  locked = true;
  return std::move(*this);
}

Feature&& Feature::Changing() && {
  changing = true;
  return std::move(*this);
}

Feature&& Feature::Wide() && {
  size = 8;
  return std::move(*this);
}

Feature&& Feature::MaxFrom(std::string its_max_feature) && {
  max_feature = std::move(its_max_feature);
  return std::move(*this);
}

Feature&& Feature::Unit(std::string its_unit) && {
  unit = std::move(its_unit);
  return std::move(*this);
}

Feature&& Feature::Tip(std::string its_tip) && {
  tip = std::move(its_tip);
  return std::move(*this);
}

void AssignAddresses(FeatureTable* table, std::uint32_t first) {
  for (Feature& feature : *table) {
    if (feature.bootstrap) continue;
    feature.address = first;
    first += (static_cast<std::uint32_t>(feature.size) + 7u) & ~7u;
  }
}

namespace {

Bytes Encode(const Feature& feature, double value) {
  if (feature.kind == Feature::Kind::kFloat) return EncodeDouble(value);
  if (feature.size == 8) return Encode64(static_cast<std::uint64_t>(value));
  return Encode32(static_cast<std::uint32_t>(value));
}

ErrorCode JudgeRange(const Feature& feature, const Bytes& value) {
  double number = 0.0;
  if (feature.kind == Feature::Kind::kFloat) {
    number = DecodeDouble(value);
  } else {
    number = feature.size == 8 ? static_cast<double>(Get64(value, 0)) : Get32(value, 0);
  }
  const bool inside = number >= feature.min && number <= feature.max;  // false for NaN
  return inside ? ErrorCode::kSuccess : ErrorCode::kInvalidParameter;
}

ErrorCode JudgeEntry(const Feature& feature, const Bytes& value) {
  const bool known =
      std::any_of(feature.entries.begin(), feature.entries.end(),
                  [&](const auto& entry) { return entry.second == Get32(value, 0); });
  return known ? ErrorCode::kSuccess : ErrorCode::kInvalidParameter;
}

}  // namespace

void AddRegisters(const FeatureTable& table, RegisterBank* bank) {
  for (const Feature& feature : table) {
    if (feature.bootstrap) continue;
    Register added;
    added.name = feature.name;
    added.address = feature.address;
    added.writable = feature.writable;
    added.selector = feature.selector;
    added.slots = feature.slots;
    for (const double value : feature.values) added.values.push_back(Encode(feature, value));
    bank->Add(std::move(added));
    if (!feature.writable) continue;
    if (feature.ranged) {
      bank->OnWrite(feature.address,
                    [feature](Bytes* value) { return JudgeRange(feature, *value); });
    } else if (feature.kind == Feature::Kind::kEnumeration) {
      bank->OnWrite(feature.address,
                    [feature](Bytes* value) { return JudgeEntry(feature, *value); });
    }
  }
}

}  // namespace palpate::gige_vision
