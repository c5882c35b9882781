// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "libs/recording/message_file.hpp"

namespace palpate::recording {

/// The files of recorded messages that a target names: itself, or, of a folder that is no
/// experiment, all MCAP or .db3 files in it, as rosbag2 and the recorder split them. Empty: it is
/// something else. Throws InputError for a folder with files of both formats, or whose files
/// rosbag2 compressed as a whole.
std::vector<std::filesystem::path> MessageFilesOf(const std::filesystem::path& target);

class RecordedMessages;

/// Messages of all files by log time. Payloads that rosbag2 compressed one by one are unpacked.
class RecordedStream {
 public:
  RecordedStream(const RecordedMessages& recorded, MessageFilter filter);

  /// The next message, or nullptr at the end; both it and its data stay until the next call. Its
  /// channel is one of RecordedMessages::contents().
  const Message* Next();

  /// What was left out so far, each with its place.
  std::vector<std::string> Problems() const;

 private:
  struct Part {
    std::size_t file = 0;
    std::unique_ptr<FileMessages> messages;
    const Message* next = nullptr;
  };

  void OpenUntil(std::int64_t time_ns);

  const RecordedMessages* recorded_;
  MessageFilter filter_;
  std::vector<std::size_t> waiting_;  ///< files not yet open, the next one last
  std::vector<Part> parts_;
  Part* current_ = nullptr;  ///< whose message Next() gave
  Message message_;
  std::string unpacked_;
  std::vector<std::string> problems_;
};

/// The messages of one run of a system: one file, or all the files into which it was split.
class RecordedMessages {
 public:
  /// Throws InputError where there are no files, or one cannot be read.
  explicit RecordedMessages(const std::vector<std::filesystem::path>& files);

  const std::vector<std::unique_ptr<MessageFile>>& files() const { return files_; }
  std::string storage_id() const { return files_.front()->storage_id(); }

  /// Channels and statistics of all files together, with ids of their own; no blocks and no
  /// attachments.
  const Contents& contents() const { return contents_; }
  /// Empty where the channel has no schema.
  const Schema& SchemaOf(const Channel& channel) const;

  /// Must not outlive this.
  RecordedStream Messages(const MessageFilter& filter = {}) const { return {*this, filter}; }

  /// What a reader that joins at `time_ns` would still get of latched topics: of each channel that
  /// `wanted` names, the newest message at or before that time.
  std::vector<StoredMessage> NewestBefore(std::int64_t time_ns,
                                          const std::function<bool(const Channel&)>& wanted) const;

  /// Of all files, each name once: the parts of a run carry the same. Throws InputError where one
  /// is damaged.
  std::vector<Attachment> Attachments() const;

 private:
  friend class RecordedStream;

  void Add(const Contents& contents);
  /// `wanted`, which knows the joint channels, of the channels of one file.
  std::function<bool(const Channel&)> OfFile(
      std::size_t file, const std::function<bool(const Channel&)>& wanted) const;

  std::vector<std::unique_ptr<MessageFile>> files_;
  Contents contents_;
  std::vector<std::map<std::uint16_t, std::uint16_t>> ids_;  ///< by file: its channel -> ours
};

}  // namespace palpate::recording
