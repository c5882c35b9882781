// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/core/number_rule.hpp"

namespace palpate {

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

/// A map whose every key must be known: Read, Require and Optional name the keys, Finish() refuses
/// the rest with "did you mean" and the keys that are allowed. Read in this order: construct,
/// Read ..., Finish.
class MapReader {
 public:
  /// Throws InputError where `node` is no map, or names a key twice.
  explicit MapReader(const ConfigNode& node);
  /// The same with the keys that the map may have; a key in another unit is refused here. `keys`
  /// must outlive the reader. Only keys of the table may be asked for, and before Finish() all of
  /// them must be that depend on no other key.
  MapReader(const ConfigNode& node, const KeyTable& keys);

  /// The entry; throws InputError where it is missing or null.
  const ConfigNode& Require(const std::string& key);
  /// The entry, or nullptr where it is missing or null.
  const ConfigNode* Optional(const std::string& key);
  /// Throws InputError at the first key that was not asked for.
  void Finish() const;

  double Number(const std::string& key, double fallback, const NumberRule& rule = kAnyNumber);

  /// Reads a value of the type and range that the table gives for the key. Where it is absent,
  /// `value` stays; throws InputError where the table requires it (a conditional key is required:
  /// ask for it only where its condition holds).
  void Read(const std::string& key, bool* value);
  void Read(const std::string& key, int* value);
  void Read(const std::string& key, double* value);
  void Read(const std::string& key, std::string* value);
  void Read(const std::string& key, Eigen::Vector3d* value);
  void Read(const std::string& key, std::optional<double>* value);
  void Read(const std::string& key, std::optional<Eigen::Vector3d>* value);
  /// Where it is relative, it counts from the folder of the file in which it stands.
  void Read(const std::string& key, std::filesystem::path* value);

 private:
  /// The entry as Require or Optional find it, whichever the table says.
  const ConfigNode* Entry(const std::string& key);
  const Key& KeyOf(const std::string& key) const;
  bool IsKnown(const std::string& key) const;  ///< it was asked for

  const ConfigNode& node_;
  const KeyTable* keys_ = nullptr;
  std::vector<std::string> known_keys_;
};

/// Throws InputError at `node`: "key 'path': message".
[[noreturn]] void Refuse(const ConfigNode& node, const std::string& message);

}  // namespace palpate
