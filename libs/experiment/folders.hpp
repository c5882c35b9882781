// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::experiment {

/// What a folder holds, by name, hidden entries left out. Throws InputError where it cannot be
/// read.
std::vector<std::filesystem::path> EntriesOf(const std::filesystem::path& folder);

/// Last part of the path, also of "a/b/" and ".".
std::string NameOf(const std::filesystem::path& folder);

/// Creates the folder and those above it. Throws RunError where it cannot.
void CreateFolder(const std::filesystem::path& folder);

/// Throws RunError where it cannot, or where `target` exists.
void CopyFile(const std::filesystem::path& source, const std::filesystem::path& target);

}  // namespace palpate::experiment
