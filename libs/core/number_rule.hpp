// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <limits>
#include <string>

namespace palpate {

/// The values that a number may take. Finite always; open bounds exclude the bound itself.
struct NumberRule {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;
};

inline constexpr NumberRule kAnyNumber{};
inline constexpr NumberRule kPositive{.min = 0.0, .min_open = true};
inline constexpr NumberRule kNonNegative{.min = 0.0};

/// "> 0 and <= 1"; empty where every finite number will do.
std::string DescribeRule(const NumberRule& rule);

}  // namespace palpate
