// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/experiment/test_folder.hpp"

#include <cstdlib>

namespace palpate::experiment {

std::filesystem::path MeasuredDataFolder() {
  namespace fs = std::filesystem;
  const char* folder = std::getenv("PALPATE_DATA_DIR");
  return folder != nullptr ? fs::path(folder) : fs::path(PALPATE_SOURCE_DIR "/../shared/data");
}

}  // namespace palpate::experiment
