// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/core/parameter.hpp"

namespace palpate {

/// The parameters of one process, read and changed as nodes of ROS 2 do it. Not thread-safe.
class ParameterTable {
 public:
  using Changes = std::vector<std::pair<std::string, ParameterValue>>;

  explicit ParameterTable(std::vector<Parameter> parameters) : parameters_(std::move(parameters)) {}

  /// nullptr: there is none.
  const Parameter* Find(std::string_view name) const;
  std::vector<std::string> Names() const;
  /// Names below `prefixes` (empty: all), at most `depth` parts long (0: of any length), as rclcpp
  /// counts them.
  std::vector<std::string> Names(const std::vector<std::string>& prefixes,
                                 std::uint64_t depth) const;

  /// Changes one. Returns the reason of a refusal, or "".
  std::string Change(const std::string& name, const ParameterValue& value);
  /// Changes all or, where one that is named cannot be changed, none.
  std::string ChangeTogether(const Changes& changes);

 private:
  /// Why no value at all can be given; "": one may be tried.
  std::string RefusalOf(const std::string& name) const;

  std::vector<Parameter> parameters_;
};

}  // namespace palpate
