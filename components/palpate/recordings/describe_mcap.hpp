// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libs/recording/mcap_files.hpp"

namespace palpate::command {

using recording::McapFilesOf;

/// What files of one recording hold.
struct McapDescription {
  nlohmann::ordered_json json;
  std::string text;  ///< in the words of `ros2 bag info`
};

/// Throws InputError where a file cannot be read.
McapDescription DescribeMcap(const std::vector<std::filesystem::path>& files);

}  // namespace palpate::command
