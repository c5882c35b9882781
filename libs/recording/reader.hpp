// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libs/recording/contents.hpp"
#include "libs/recording/message_stream.hpp"

namespace palpate::recording {

/// Reads an MCAP file: by its index where it has one, else by going through all of it. What is cut
/// or damaged is left out and told.
class Reader {
 public:
  /// Throws InputError where the file cannot be read or is no MCAP recording.
  explicit Reader(const std::filesystem::path& file);

  const std::filesystem::path& path() const { return file_->path(); }
  std::uint64_t size() const { return file_->size(); }
  const Contents& contents() const { return contents_; }

  /// Empty where the channel has no schema.
  const Schema& SchemaOf(const Channel& channel) const;

  /// Messages in the order of their log time. Must not outlive this.
  MessageStream Messages(const MessageFilter& filter = {}) const;

  /// What a reader that joins at `time_ns` would still get of latched topics: of each channel that
  /// `wanted` names, the newest message at or before that time.
  std::vector<StoredMessage> NewestBefore(std::int64_t time_ns,
                                          const std::function<bool(const Channel&)>& wanted) const;

  /// Throw InputError where it is damaged.
  Attachment Read(const AttachmentIndex& index) const;
  Metadata Read(const MetadataIndex& index) const;

 private:
  std::unique_ptr<InputFile> file_;
  Contents contents_;
};

}  // namespace palpate::recording
