// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

namespace palpate::command {

/// For outputs of long work, before it starts. Writes nothing.
///
/// Throws InputError (path, cause, remedy) where WriteFile could not write `file`: its folder is
/// absent or may not be written to, or a folder has its name. An existing file is fine.
void CheckOutputFile(const std::filesystem::path& file);

/// The same for a folder that is made where absent, with its parents.
void CheckOutputFolder(const std::filesystem::path& folder);

}  // namespace palpate::command
