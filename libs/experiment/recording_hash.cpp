// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/recording_hash.hpp"

#include <filesystem>

#include "libs/core/file.hpp"
#include "libs/core/sha256.hpp"

namespace palpate::experiment {

std::string HashRecordings(const std::vector<const Recording*>& recordings) {
  std::string digests;
  for (const Recording* recording : recordings) {
    for (const char* name : {"recording.yaml", "actuation.csv", "markers.csv", "loads.csv"}) {
      const std::filesystem::path file = recording->folder / name;
      if (std::filesystem::exists(file)) {
        digests += std::string(name) + " " + Sha256Hex(ReadFile(file)) + "\n";
      }
    }
  }
  return "sha256-" + Sha256Hex(digests);
}

}  // namespace palpate::experiment
