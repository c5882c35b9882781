// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libs/recording/reader.hpp"

namespace palpate::recording {

struct RepairResult {
  std::uint64_t messages = 0;         ///< that were saved
  std::vector<std::string> problems;  ///< what was lost, each with its place
};

/// Writes what is whole of a cut or damaged recording to a new file, with index and statistics.
/// Messages, attachments and metadata are the same to the bit and in the same order; compression
/// is that of the first chunk. Throws InputError for a file that is no recording, RunError where
/// `repaired` exists or cannot be written.
RepairResult Repair(const std::filesystem::path& damaged, const std::filesystem::path& repaired);

}  // namespace palpate::recording
