// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <vector>

namespace palpate::recording {

/// The MCAP files that a target names: itself, or, of a folder that is no experiment, all of it (as
/// rosbag2 and the recorder split them). Empty: it is something else.
std::vector<std::filesystem::path> McapFilesOf(const std::filesystem::path& target);

}  // namespace palpate::recording
