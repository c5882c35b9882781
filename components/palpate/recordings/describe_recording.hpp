// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpate::command {

/// What files of one recording hold.
struct RecordingDescription {
  nlohmann::ordered_json json;
  std::string text;  ///< in the words of `ros2 bag info`
};

/// Of MCAP files and .db3 files of rosbag2. Throws InputError where one cannot be read.
RecordingDescription DescribeRecording(const std::vector<std::filesystem::path>& files);

}  // namespace palpate::command
