// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

namespace palpate {

/// All bytes of a file. Throws InputError (file: cause) where it cannot be read.
std::string ReadFile(const std::filesystem::path& file);

/// Writes all of `bytes` and closes; an existing file is replaced only once the new one is whole.
/// Throws RunError (file: cause) where that fails, for instance on a full disk.
void WriteFile(const std::filesystem::path& file, const std::string& bytes);

}  // namespace palpate
