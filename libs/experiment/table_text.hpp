// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace palpate::experiment {

/// The text of a table as UTF-8 without a byte order mark, whatever wrote it: UTF-16 with a mark is
/// converted, and lines that end in CR alone end in LF. Throws InputError where the file cannot be
/// read.
std::string ReadTableText(const std::filesystem::path& file);

/// Whether the cell is what programs write for a missing sample: nothing, NaN, -nan(ind), NULL,
/// N/A, #N/A, 1.#QNAN.
bool StandsForMissing(std::string_view cell);

}  // namespace palpate::experiment
