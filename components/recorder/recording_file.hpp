// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/recorder/recorded_message.hpp"
#include "libs/recording/writer.hpp"

namespace palpate::recorder {

/// What every file of a recording holds besides messages.
struct FileExtras {
  recording::WriterOptions options;
  std::vector<recording::Attachment> attachments;
  std::vector<recording::Metadata> metadata;
};

/// One MCAP file of recorded messages.
class RecordingFile {
 public:
  /// Throws RunError where the file exists or cannot be written.
  RecordingFile(const std::filesystem::path& file, const FileExtras& extras);

  /// Throws RunError, as recording::Writer does.
  void Write(const RecordedMessage& message);
  void Flush() { writer_.Flush(); }
  void Close() { writer_.Close(); }

  std::uint64_t size() const { return writer_.size(); }

 private:
  std::uint16_t ChannelOf(const RecordedMessage& message);

  recording::Writer writer_;
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t sequence = 0;
  };
  std::map<std::shared_ptr<const TopicDescription>, Channel> channels_;
};

/// When the next file begins. Zero: never.
struct Splitting {
  std::uint64_t bytes = 0;
  double duration_s = 0.0;

  bool any() const { return bytes > 0 || duration_s > 0.0; }
};

/// A recording that may have many files: "name.mcap", or, where it is split, "name_0000.mcap" and
/// so on. Each begins with the last message of every latched topic, so that it can stand alone.
class RecordingFiles {
 public:
  /// Begins the first file. Throws RunError.
  RecordingFiles(std::filesystem::path file, FileExtras extras, const Splitting& splitting);

  /// Throws RunError where the message, or a chunk before it, could not be written.
  void Write(const RecordedMessage& message);
  void Flush() { current_->Flush(); }
  void Close() { current_->Close(); }

  const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Of all files.
  std::uint64_t size() const { return closed_bytes_ + current_->size(); }

 private:
  void Begin();
  bool IsFull(const RecordedMessage& next) const;

  std::filesystem::path file_;
  FileExtras extras_;
  Splitting splitting_;
  std::vector<std::filesystem::path> files_;
  std::unique_ptr<RecordingFile> current_;
  std::uint64_t closed_bytes_ = 0;
  std::optional<std::int64_t> first_received_ns_;  ///< of the current file
  std::map<std::string, RecordedMessage> latched_;
};

}  // namespace palpate::recorder
