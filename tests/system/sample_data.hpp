// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::system_test {

/// A folder of its own for one test, removed at its end.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
};

/// Where the sample data act on a robot of config/robots.
struct Sample {
  std::filesystem::path robot;
  std::filesystem::path data;
  std::string contact;  ///< as --contact takes it
};

/// The recordings of tests/data/beam_calculix, about `frame_count` frames of each.
Sample WriteBeamSample(const TestFolder& folder, size_t frame_count);

/// The four-legged robot, its cables pulled and a force on its top: one recording with a reference.
Sample WriteFourLegSample(const TestFolder& folder);

}  // namespace palpate::system_test
