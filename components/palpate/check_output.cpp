// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/check_output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void RefuseOutput(const fs::path& output, const std::string& cause) {
  throw InputError(SourceLocation{output.string()}, "cannot be written: " + cause);
}

/// The folder that holds `path`.
fs::path FolderOf(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

void RequireWritable(const fs::path& existing, int access_mode, const fs::path& output) {
  if (access(existing.c_str(), access_mode) == 0) return;
  const std::string cause = std::strerror(errno);
  RefuseOutput(output, existing.string() + ": " + cause + "; give another place");
}

void RequireWritableFolder(const fs::path& folder, const fs::path& output) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    RefuseOutput(output, folder.string() + " is not a folder; give another place");
  }
  RequireWritable(folder, W_OK | X_OK, output);
}

}  // namespace

void CheckOutputFile(const fs::path& file) {
  if (!file.has_filename()) RefuseOutput(file, "this is no name of a file");
  std::error_code error;
  if (fs::is_directory(file, error)) {
    RefuseOutput(file, "a folder has that name; give a file");
  }
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) {
    RequireWritable(file, W_OK, file);
    return;
  }
  const fs::path folder = FolderOf(file);
  if (!fs::exists(folder, error)) {
    RefuseOutput(file, "the folder " + folder.string() + " does not exist; create it first");
  }
  RequireWritableFolder(folder, file);
}

void CheckOutputFolder(const fs::path& folder) {
  std::error_code error;
  fs::path existing = fs::absolute(folder).lexically_normal();
  while (!fs::exists(existing, error) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  RequireWritableFolder(existing, folder);
}

}  // namespace palpate::command
