// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "components/view/picture/image.hpp"

namespace palpate::view {

/// Writes an 8-bit RGB PNG. The same image gives the same bytes (no time stamp inside).
/// Throws RunError where the file cannot be opened, or not all of it could be written (full
/// disk); no half-written file is left behind then.
void WritePng(const std::filesystem::path& path, const Image& image);

}  // namespace palpate::view
