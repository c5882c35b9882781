// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/coarse_robot.hpp"

#include "libs/core/check.hpp"
#include "libs/core/file.hpp"

namespace palpate::blind {

namespace {

namespace fs = std::filesystem;

/// `from` is there.
void Exchange(const std::string& from, const std::string& to, std::string* text) {
  const std::size_t begin = text->find(from);
  PALPATE_CHECK(begin != std::string::npos, from);
  text->replace(begin, from.size(), to);
}

}  // namespace

bool IsCoarse(const std::string& robot) { return robot.starts_with("pneumatic_"); }

fs::path WriteCoarseRobot(const std::string& robot, const fs::path& folder) {
  const fs::path config = fs::path(PALPATE_SOURCE_DIR) / "config";
  std::string text = ReadFile(config / "robots" / (robot + ".yaml"));
  Exchange("element: tet10", "element: tet4", &text);
  Exchange("file: " + robot + ".msh",
           "file: " + (config / "scenarios" / (robot + "_coarse.msh")).string(), &text);
  fs::path file = folder / (robot + ".yaml");
  WriteFile(file, text);
  return file;
}

std::string CoarseScenario(const std::string& scenario) {
  std::string text = scenario;
  Exchange("element: tet10", "element: tet4", &text);
  return text;
}

}  // namespace palpate::blind
