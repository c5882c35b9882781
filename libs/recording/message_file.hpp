// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "libs/recording/contents.hpp"
#include "libs/recording/message_stream.hpp"

namespace palpate::recording {

/// Messages of one file, one after the other by log time.
class FileMessages {
 public:
  virtual ~FileMessages() = default;
  /// The next message, or nullptr at the end; both it and its data stay until the next call.
  virtual const Message* Next() = 0;
  /// What was left out so far, each with its place.
  virtual std::vector<std::string> Problems() const = 0;
};

/// A file of recorded messages, whatever its format.
class MessageFile {
 public:
  virtual ~MessageFile() = default;
  virtual const std::filesystem::path& path() const = 0;
  virtual std::uint64_t size() const = 0;
  /// "mcap" or "sqlite3", as rosbag2 names its storage.
  virtual std::string storage_id() const = 0;
  virtual const Contents& contents() const = 0;
  /// Must not outlive this.
  virtual std::unique_ptr<FileMessages> Messages(const MessageFilter& filter) const = 0;
  /// Of each channel that `wanted` names, the newest message at or before that time.
  virtual std::vector<StoredMessage> NewestBefore(
      std::int64_t time_ns, const std::function<bool(const Channel&)>& wanted) const = 0;
  /// Throws InputError where one is damaged.
  virtual std::vector<Attachment> Attachments() const = 0;
};

/// Opens an MCAP file, or a .db3 file of rosbag2. Throws InputError where it is neither, or cannot
/// be read.
std::unique_ptr<MessageFile> OpenMessageFile(const std::filesystem::path& file);

/// A database of rosbag2's storage "sqlite3". Throws InputError where it is none.
std::unique_ptr<MessageFile> OpenSqliteFile(const std::filesystem::path& file);

/// Whether there is a file that begins as an SQLite database does.
bool IsSqlite(const std::filesystem::path& file);

}  // namespace palpate::recording
