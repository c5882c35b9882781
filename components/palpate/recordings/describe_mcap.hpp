// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpate::command {

/// The MCAP files that a target names: itself, or, of a folder that is no experiment, all of it (as
/// rosbag2 and the recorder split them). Empty: it is something else.
std::vector<std::filesystem::path> McapFilesOf(const std::filesystem::path& target);

/// What files of one recording hold.
struct McapDescription {
  nlohmann::ordered_json json;
  std::string text;  ///< in the words of `ros2 bag info`
};

/// Throws InputError where a file cannot be read.
McapDescription DescribeMcap(const std::vector<std::filesystem::path>& files);

}  // namespace palpate::command
