// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

namespace palpate::command {

/// A folder of one test, emptied when it is made and removed with it.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  const std::filesystem::path& path() const { return folder_; }

  /// Writes a text file and returns its path.
  std::filesystem::path Write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
};

/// Writes a soft bar (20 x 20 x 80 mm along x, clamped at x = 0, one cable "top" along its upper
/// edge that is attached at the tip, 81 nodes) and returns its robot file.
std::filesystem::path WriteBarRobot(const TestFolder& folder);

}  // namespace palpate::command
