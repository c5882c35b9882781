// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_files.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;

/// The files that result.json lists; none where it is absent or of something else.
std::vector<std::string> FilesOfEarlierSolve(const fs::path& folder) {
  const fs::path result = folder / "result.json";
  std::error_code error;
  if (!fs::is_regular_file(result, error)) return {};
  const auto json = nlohmann::json::parse(ReadFile(result), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("palpate") || !json.contains("files")) return {};
  std::vector<std::string> files;
  for (const auto& entry : json["files"]) {
    if (!entry.is_string()) continue;
    const auto name = entry.get<std::string>();
    if (fs::path(name).filename() == name) files.push_back(name);  // of this folder
  }
  return files;
}

}  // namespace

void MakeRoomForResults(const fs::path& folder, const std::vector<std::string>& planned) {
  const std::vector<std::string> own = FilesOfEarlierSolve(folder);
  std::error_code error;
  for (const std::string& name : planned) {
    const bool is_own = std::find(own.begin(), own.end(), name) != own.end();
    if (is_own || !fs::exists(folder / name, error)) continue;
    throw InputError(SourceLocation{(folder / name).string()},
                     "is there already, and no result.json beside it says that palpate solve wrote "
                     "it; move it away, or give another --out");
  }
  for (const std::string& name : own) {
    if (fs::is_regular_file(folder / name, error)) fs::remove(folder / name, error);
  }
}

}  // namespace palpate::command
