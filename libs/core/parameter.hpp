// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpate {

/// A value of a parameter as ROS 2 has it. The index of the alternative is its number in
/// rcl_interfaces/msg/ParameterType; monostate: not set.
using ParameterValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::uint8_t>,
                 std::vector<bool>, std::vector<std::int64_t>, std::vector<double>,
                 std::vector<std::string>>;

/// One setting of a process, as it shows it to others.
struct Parameter {
  std::string name;  ///< "shape.contact_radius_m"
  ParameterValue value;
  std::string description = {};
  std::string constraints = {};  ///< what it may be, in words; empty: anything of its type
  std::optional<std::pair<double, double>> range = {};  ///< of a number, both ends included

  /// Why it cannot be changed while the process runs; empty: it can.
  std::string fixed_because = {};
  /// Changes it and returns "", or the reason of a refusal. Of parameters that can be changed.
  std::function<std::string(const ParameterValue&)> change = {};
};

}  // namespace palpate
