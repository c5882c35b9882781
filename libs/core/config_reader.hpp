// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

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

/// Each of these throws InputError (file:line:column, key, value, rule) on the wrong type, a value
/// that is not finite, or one outside the rule. YAML's traps (012, no, 1_000) are refused.
double ReadNumber(const ConfigNode& node, const NumberRule& rule = kAnyNumber);
int ReadInteger(const ConfigNode& node, int min, int max);
bool ReadBool(const ConfigNode& node);
std::string ReadText(const ConfigNode& node);
/// One of `choices`, with "did you mean".
std::string ReadChoice(const ConfigNode& node, const std::vector<std::string>& choices);
Eigen::Vector3d ReadVector3(const ConfigNode& node, const NumberRule& rule = kAnyNumber);
/// List of any number of numbers.
std::vector<double> ReadNumbers(const ConfigNode& node, const NumberRule& rule = kAnyNumber);
/// [3 x n], one column for each [x, y, z] of the list.
Eigen::Matrix3Xd ReadPoints(const ConfigNode& node);

/// A map whose every key must be known: Require/Optional name the keys, Finish() refuses the rest
/// with "did you mean". Read in this order: construct, Require/Optional ..., Finish.
class MapReader {
 public:
  /// Throws InputError where `node` is no map, or names a key twice.
  explicit MapReader(const ConfigNode& node);

  /// The entry; throws InputError where it is missing or null.
  const ConfigNode& Require(const std::string& key);
  /// The entry, or nullptr where it is missing or null.
  const ConfigNode* Optional(const std::string& key);
  /// Throws InputError at the first unknown key.
  void Finish() const;

  double Number(const std::string& key, double fallback, const NumberRule& rule = kAnyNumber);

 private:
  const ConfigNode& node_;
  std::vector<std::string> known_keys_;
};

/// Throws InputError at `node`: "key 'path': message".
[[noreturn]] void Refuse(const ConfigNode& node, const std::string& message);

}  // namespace palpate
