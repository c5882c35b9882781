// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "tests/support/test_folder.hpp"

namespace palpate::command {

using test_support::TestFolder;

/// Writes a soft bar (20 x 20 x 80 mm along x, clamped at x = 0, one cable "top" along its upper
/// edge that is attached at the tip, 81 nodes) and returns its robot file.
std::filesystem::path WriteBarRobot(const TestFolder& folder);

}  // namespace palpate::command
