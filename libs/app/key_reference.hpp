// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/key_table.hpp"

namespace palpate::app {

/// Markdown sections (###, and #### for the maps inside) of the keys of these files: key, type and
/// range, unit, default, meaning. A map that several keys share is printed once.
std::string PrintKeysMarkdown(const std::vector<const KeyTable*>& files);

/// JSON Schema (draft 2020-12) of a file with these keys, for editors. It refuses unknown keys,
/// missing keys, wrong types and numbers out of range. It leaves out rules between keys except
/// "exactly one of" and "at most one of".
std::string PrintJsonSchema(const KeyTable& file);

}  // namespace palpate::app
