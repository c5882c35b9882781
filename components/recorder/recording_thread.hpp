// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/recorder/config.hpp"
#include "components/recorder/recent_messages.hpp"
#include "components/recorder/recording_file.hpp"

namespace palpate::recorder {

/// Settings of the files as the library has them.
recording::WriterOptions WriterOptionsOf(const Config& config, const std::string& library);

/// Takes messages from any thread without blocking it, and writes them in a thread of its own.
class RecordingThread {
 public:
  /// `file`: nullopt keeps the last seconds only. `on_change`: called from its threads after an
  /// error, and when a snapshot is written. Throws RunError where the file cannot be begun.
  RecordingThread(const Config& config, std::optional<std::filesystem::path> file,
                  FileExtras extras, std::function<void()> on_change);
  /// Stop(), without its errors.
  ~RecordingThread();
  RecordingThread(const RecordingThread&) = delete;
  RecordingThread& operator=(const RecordingThread&) = delete;

  /// False where it is dropped: more wait for the disk than may, or it has failed.
  bool Push(RecordedMessage message);

  /// Writes the last seconds, as they are once all that was pushed before is written, to a new
  /// file; `reason` goes into its metadata and, where it is not empty, to a text file beside it.
  void SaveRecent(const std::filesystem::path& file, const std::string& reason);

  /// Writes what waits, and closes all files. Throws RunError where any of that failed; what was
  /// written can be read.
  void Stop();

  struct State {
    std::string error;  ///< empty: none
    std::vector<std::filesystem::path> files;
    std::vector<std::filesystem::path> snapshots;  ///< written so far
    std::uint64_t written_bytes = 0;
    std::uint64_t waiting_bytes = 0;
    double recent_s = 0.0;       ///< how far back all topics reach
    double recent_slot_s = 0.0;  ///< in which one message of the largest topics is kept; 0: all
  };
  State state() const;

 private:
  struct Request {
    std::filesystem::path file;
    std::string reason;
  };
  struct Work {
    std::deque<RecordedMessage> messages;
    std::vector<Request> requests;
    bool stop = false;
  };

  void Run();
  Work Wait();
  void WriteAll(const Work& work);
  void Fail(const std::string& error);
  void WriteSnapshot(const Request& request);

  Config config_;
  FileExtras extras_;
  std::function<void()> on_change_;
  std::unique_ptr<RecordingFiles> files_;  ///< nullptr: only the last seconds are kept
  RecentMessages recent_;
  std::int64_t flushed_ns_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Work work_;
  State state_;
  std::thread thread_;
};

}  // namespace palpate::recorder
