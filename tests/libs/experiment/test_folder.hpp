// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "libs/core/error.hpp"

namespace palpate::experiment {

/// A folder of this test alone, empty at the start and removed at the end.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file below the folder (folders on the way are made) and returns its path.
  std::filesystem::path Write(const std::string& name, const std::string& content) const;

 private:
  std::filesystem::path path_;
};

/// The folder of the measured data that the project does not hold: PALPATE_DATA_DIR, else
/// ../shared/data beside the project.
std::filesystem::path MeasuredDataFolder();

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

}  // namespace palpate::experiment
