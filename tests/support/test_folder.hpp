// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::test_support {

/// A folder of this test (or, made in SetUpTestSuite, of its suite) alone, empty at the start and
/// removed at the end.
class TestFolder {
 public:
  TestFolder() {
    static int count = 0;
    const auto& tests = *testing::UnitTest::GetInstance();
    const auto* test = tests.current_test_info();
    std::string name = std::string("palpate_") + tests.current_test_suite()->name();
    if (test != nullptr) name += std::string("_") + test->name();
    // Parameterised suites and tests have slashes in their names.
    std::replace(name.begin(), name.end(), '/', '_');
    name += "_" + std::to_string(getpid()) + "_" + std::to_string(count++);
    path_ = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes a file below the folder (folders on the way are made) and returns its path.
  std::filesystem::path Write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    WriteFile(file, content);
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// Message of the Error that `action` throws; a test failure and "" where it throws none.
template <typename Error = InputError>
std::string MessageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

}  // namespace palpate::test_support
