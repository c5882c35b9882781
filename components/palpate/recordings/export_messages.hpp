// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "libs/recording/recorded_messages.hpp"

namespace palpate::command {

enum class CloudFormat { kPly, kPcd };

struct ExportOptions {
  std::filesystem::path out;        ///< folder
  std::vector<std::string> topics;  ///< empty: all
  CloudFormat clouds = CloudFormat::kPly;
};

/// What became of one topic.
struct ExportedTopic {
  std::string topic;
  std::filesystem::path target;  ///< the CSV, or the folder of images, clouds or meshes
  std::size_t messages = 0;      ///< that were written
  std::size_t left_out = 0;      ///< that could not be decoded, or are no such image or cloud
  std::string reason;            ///< why
};

/// Writes the messages of a recording as files: images as PNG, clouds as PLY or PCD, mesh states as
/// VTU and PVD, all other topics as CSV. Throws InputError for a topic that is not there, RunError
/// where a file cannot be written.
std::vector<ExportedTopic> ExportMessages(const recording::RecordedMessages& reader,
                                          const ExportOptions& options);

}  // namespace palpate::command
