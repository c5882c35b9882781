// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/parameter_table.hpp"

#include <algorithm>
#include <cstddef>

#include "libs/core/text.hpp"

namespace palpate {

namespace {

constexpr char kSeparator = '.';

bool IsListed(const std::string& name, const std::vector<std::string>& prefixes,
              std::uint64_t depth) {
  const auto is_above = [&](std::string_view below) {
    return depth == 0 ||
           static_cast<std::uint64_t>(std::count(below.begin(), below.end(), kSeparator)) < depth;
  };
  if (prefixes.empty()) return is_above(name);
  return std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& prefix) {
    if (name == prefix) return true;
    return name.starts_with(prefix + kSeparator) &&
           is_above(std::string_view(name).substr(prefix.size() + 1));
  });
}

}  // namespace

const Parameter* ParameterTable::Find(std::string_view name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& known) { return known.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

std::vector<std::string> ParameterTable::Names() const { return Names({}, 0); }

std::vector<std::string> ParameterTable::Names(const std::vector<std::string>& prefixes,
                                               std::uint64_t depth) const {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters_) {
    if (IsListed(parameter.name, prefixes, depth)) names.push_back(parameter.name);
  }
  return names;
}

std::string ParameterTable::RefusalOf(const std::string& name) const {
  const Parameter* parameter = Find(name);
  if (parameter == nullptr) return "no such parameter" + DidYouMean(name, Names());
  return parameter->fixed_because;
}

std::string ParameterTable::Change(const std::string& name, const ParameterValue& value) {
  if (std::string refusal = RefusalOf(name); !refusal.empty()) return refusal;
  Parameter& parameter = parameters_[static_cast<std::size_t>(Find(name) - parameters_.data())];
  std::string refusal = parameter.change(value);
  if (refusal.empty()) parameter.value = value;
  return refusal;
}

std::string ParameterTable::ChangeTogether(const Changes& changes) {
  for (const auto& [name, value] : changes) {
    if (std::string refusal = RefusalOf(name); !refusal.empty()) return name + ": " + refusal;
  }
  const std::vector<Parameter> before = parameters_;
  for (const auto& [name, value] : changes) {
    const std::string refusal = Change(name, value);
    if (refusal.empty()) continue;
    for (const auto& [changed, unused] : changes) {
      if (changed == name) break;
      const auto old = std::find_if(before.begin(), before.end(),
                                    [&](const Parameter& known) { return known.name == changed; });
      (void)Change(changed, old->value);
    }
    return name + ": " + refusal;
  }
  return "";
}

}  // namespace palpate
