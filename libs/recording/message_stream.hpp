// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "libs/recording/contents.hpp"

namespace palpate::recording {

/// Which messages of a recording are wanted.
struct MessageFilter {
  std::int64_t start_time_ns = std::numeric_limits<std::int64_t>::min();  ///< first log time
  std::int64_t end_time_ns = std::numeric_limits<std::int64_t>::max();    ///< last log time
  std::function<bool(const Channel&)> wanted;                             ///< empty: all channels
};

/// A message with its own bytes.
struct StoredMessage {
  Message message;  ///< its data are empty
  std::string data;
};

/// The messages of a recording in the order of their log time; those of one time in the order of
/// the file. Only the chunks that overlap the current time are in memory.
class MessageStream {
 public:
  /// Both must outlive this. Damaged blocks are left out; problems() names them.
  MessageStream(const InputFile& file, const Contents& contents, const MessageFilter& filter);
  ~MessageStream();
  MessageStream(MessageStream&&) noexcept;
  MessageStream& operator=(MessageStream&&) noexcept;

  /// The next message, or nullptr at the end; both it and its data stay until the next call.
  const Message* Next();

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct OpenBlock;

  bool IsWanted(const Block& block) const;
  void Open(std::size_t index);

  const InputFile* file_;
  const Contents* contents_;
  MessageFilter filter_;
  std::vector<bool> channels_;                    ///< by id: whether it is wanted
  std::vector<std::size_t> waiting_;              ///< blocks not yet open, the next one last
  std::vector<std::unique_ptr<OpenBlock>> open_;  ///< heap, the next message's block first
  std::unique_ptr<OpenBlock> current_;            ///< holds the message that Next() gave
  Message message_;
  std::vector<std::string> problems_;
};

}  // namespace palpate::recording
