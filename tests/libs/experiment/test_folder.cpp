// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/experiment/test_folder.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string>

#include "libs/core/file.hpp"

namespace palpate::experiment {

namespace fs = std::filesystem;

TestFolder::TestFolder() {
  static int count = 0;
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  path_ = fs::path(testing::TempDir()) /
          (std::string("palpate_") + test->test_suite_name() + "_" + test->name() + "_" +
           std::to_string(getpid()) + "_" + std::to_string(count++));
  fs::remove_all(path_);
  fs::create_directories(path_);
}

TestFolder::~TestFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path TestFolder::Write(const std::string& name, const std::string& content) const {
  const fs::path file = path_ / name;
  fs::create_directories(file.parent_path());
  WriteFile(file, content);
  return file;
}

fs::path MeasuredDataFolder() {
  const char* folder = std::getenv("PALPATE_DATA_DIR");
  return folder != nullptr ? fs::path(folder) : fs::path(PALPATE_SOURCE_DIR "/../shared/data");
}

}  // namespace palpate::experiment
