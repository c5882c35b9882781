// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "libs/core/config_node.hpp"

namespace palpate::app {

/// Reads one YAML document as a settings tree; an empty file is a null node. A
/// palpate::ConfigLoader. Throws InputError (file:line:column) where the file cannot be read, is
/// not valid YAML, holds nothing but a text, names a key twice, or uses what settings have no need
/// of: anchors, aliases, tags, several documents, keys that are not plain words. A message shows at
/// most 80 characters of the file.
ConfigNode LoadYaml(const std::filesystem::path& file);

/// The same for a text; `name` takes the place of the file in messages.
ConfigNode ParseYaml(const std::string& text, const std::string& name);

}  // namespace palpate::app
