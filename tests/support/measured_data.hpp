// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdlib>
#include <filesystem>

namespace palpate::test_support {

/// The folder of the measured data that is not part of the project: PALPATE_DATA_DIR, else
/// ../shared/data beside the sources. It need not exist.
inline std::filesystem::path MeasuredDataFolder() {
  const char* folder = std::getenv("PALPATE_DATA_DIR");
  return folder != nullptr ? folder : PALPATE_SOURCE_DIR "/../shared/data";
}

}  // namespace palpate::test_support
