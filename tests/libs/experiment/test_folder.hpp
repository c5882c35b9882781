// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "tests/support/test_folder.hpp"

namespace palpate::experiment {

using test_support::MessageOf;
using test_support::TestFolder;

/// The folder of the measured data that the project does not hold: PALPATE_DATA_DIR, else
/// ../shared/data beside the project.
std::filesystem::path MeasuredDataFolder();

}  // namespace palpate::experiment
