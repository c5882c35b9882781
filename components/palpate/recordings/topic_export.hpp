// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "components/offline/messages/message_type.hpp"
#include "components/palpate/recordings/export_messages.hpp"

namespace palpate::command {

/// Writes the messages of one topic as files.
class TopicExport {
 public:
  virtual ~TopicExport() = default;
  /// Empty: done; else why the message is left out. Throws RunError where a file cannot be written.
  [[nodiscard]] virtual std::string Take(const recording::Message& message) = 0;
  /// After the last message.
  virtual void Finish() {}
};

/// One CSV: t_s from the beginning of the recording, log_time_ns, then a column for each value.
std::unique_ptr<TopicExport> MakeCsvExport(offline::MessageType type, std::filesystem::path file,
                                           std::int64_t start_ns);
/// STAMP.png of 16-bit depth and of colour, packed images too; STAMP.ply or .pcd of clouds.
std::unique_ptr<TopicExport> MakeImageExport(offline::MessageType type,
                                             std::filesystem::path folder);
std::unique_ptr<TopicExport> MakeCloudExport(offline::MessageType type,
                                             std::filesystem::path folder, CloudFormat format);
/// STAMP.vtu of mesh states, undeformed points with displacement_m, and body.pvd with their times.
/// The meshes are those of the recording's Mesh messages.
std::unique_ptr<TopicExport> MakeMeshExport(offline::MessageType type, std::filesystem::path folder,
                                            const recording::RecordedMessages& reader,
                                            std::int64_t start_ns);

}  // namespace palpate::command
