// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/mcap_files.hpp"

#include <algorithm>
#include <system_error>

#include "libs/recording/contents.hpp"

namespace palpate::recording {

namespace fs = std::filesystem;

namespace {

bool IsExperiment(const fs::path& folder) {
  return fs::exists(folder / "experiment.yaml") || fs::exists(folder / "recording.yaml");
}

}  // namespace

std::vector<fs::path> McapFilesOf(const fs::path& target) {
  std::error_code error;
  if (!fs::is_directory(target, error)) {
    return IsMcap(target) ? std::vector<fs::path>{target} : std::vector<fs::path>{};
  }
  std::vector<fs::path> files;
  if (IsExperiment(target)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(target)) {
    if (IsMcap(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace palpate::recording
