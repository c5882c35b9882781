// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/folders.hpp"

#include <algorithm>
#include <system_error>

#include "libs/core/error.hpp"

namespace palpate::experiment {

namespace fs = std::filesystem;

std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->path().filename().string().starts_with('.')) entries.push_back(entry->path());
  }
  if (error) {
    throw InputError(SourceLocation{folder.string()}, "cannot be read: " + error.message());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::string NameOf(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

void CreateFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(folder.string() + ": cannot be created: " + error.message());
}

void CopyFile(const fs::path& source, const fs::path& target) {
  std::error_code error;
  fs::copy_file(source, target, error);
  if (error) {
    throw RunError(source.string() + ": cannot be copied to " + target.string() + ": " +
                   error.message());
  }
}

}  // namespace palpate::experiment
