// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/test_folder.hpp"

namespace palpate::system_test {

using test_support::TestFolder;

/// Where the sample data act on a robot of config/robots.
struct Sample {
  std::filesystem::path robot;
  std::filesystem::path data;
  std::string contact;     ///< as --contact takes it
  int estimate_exits = 0;  ///< of palpate estimate: 1 where a rest recording has forces
};

/// The recordings of tests/data/beam_calculix, about `frame_count` frames of each.
Sample WriteBeamSample(const TestFolder& folder, size_t frame_count);

/// The four-legged robot, its cables pulled and a force on its top: one recording with a reference.
Sample WriteFourLegSample(const TestFolder& folder);

}  // namespace palpate::system_test
