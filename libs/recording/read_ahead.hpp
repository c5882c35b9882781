// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "libs/core/bounded_queue.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::recording {

/// Reads and unpacks the messages of a recording in a thread of its own, before they are asked for.
/// So whoever sends them in real time never waits for the disk.
class ReadAhead {
 public:
  /// At most `kBatches` times the larger of `kBatchBytes` and one message are in memory.
  static constexpr std::size_t kBatches = 4;
  static constexpr std::size_t kBatchBytes = std::size_t{4} << 20;

  /// What `stream` reads must outlive this.
  explicit ReadAhead(RecordedStream stream);
  /// Waits for the chunk that is being read.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// As RecordedStream::Next(): the next message, or nullptr at the end; both it and its data stay
  /// until the next call. Throws what reading threw, after all messages before that.
  const Message* Next();

 private:
  struct Batch {
    std::vector<Message> messages;  ///< without data
    std::vector<std::size_t> ends;  ///< of their data in `bytes`
    std::string bytes;
    bool is_last = false;
    std::exception_ptr error;

    void Clear();
    void Add(const Message& message);
  };

  void Read();
  bool Fill(Batch* batch);

  RecordedStream stream_;
  BoundedQueue<Batch> batches_{kBatches - 2};  // one more is read, another one is being filled
  BoundedQueue<Batch> used_{kBatches};         ///< their memory is used again: it is in place
  std::optional<Batch> current_;
  std::size_t next_ = 0;  ///< message of `current_`
  Message message_;
  std::thread thread_;
};

}  // namespace palpate::recording
