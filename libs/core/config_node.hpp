// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate {

struct ConfigEntry;

/// A settings file as a tree of scalars, lists and maps, each knowing where it stood.
/// Libraries read their settings from this tree; which parser made it is not their business
/// (libs/app makes it from YAML).
struct ConfigNode {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  SourceLocation where;
  SourceLocation key_where;          ///< of an entry of a map: where its key stands
  std::string path;                  ///< e.g. "cables[2].path_m", for messages; empty at the root
  std::string text;                  ///< of a scalar, unquoted
  bool quoted = false;               ///< a scalar that was quoted is text, never a number
  std::vector<ConfigNode> items;     ///< of a list
  std::vector<ConfigEntry> entries;  ///< of a map, in file order

  /// The entry of a map, or nullptr.
  const ConfigNode* Find(const std::string& key) const;
};

/// One "key: value" of a map.
struct ConfigEntry {
  std::string key;
  ConfigNode value;
};

/// Reads and parses one file. Throws InputError with file:line:column.
using ConfigLoader = std::function<ConfigNode(const std::filesystem::path&)>;

}  // namespace palpate
