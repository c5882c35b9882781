// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <filesystem>

#include "tests/system/independent/calculix_body.hpp"

namespace palpate::test_support {

/// A finger of 28 x 28 x 110 mm that stands on its clamp, of a mesh of its own, with one cable to a
/// side.
CalculixBody FingerBody(const std::array<int, 3>& cells);

/// Its robot file and mesh, which is coarser than CalculiX'.
std::filesystem::path WriteFinger(const std::filesystem::path& folder);

}  // namespace palpate::test_support
