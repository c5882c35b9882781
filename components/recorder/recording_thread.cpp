// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/recording_thread.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::recorder {

namespace {

std::uint64_t Bytes(double megabytes) {
  return static_cast<std::uint64_t>(std::llround(1e6 * megabytes));
}

}  // namespace

recording::WriterOptions WriterOptionsOf(const Config& config, const std::string& library) {
  recording::WriterOptions options;
  if (config.compression == "zstd") options.compression = recording::Compression::kZstd;
  if (config.compression == "lz4") options.compression = recording::Compression::kLz4;
  options.zstd_level = config.zstd_level;
  options.chunk_bytes = Bytes(config.chunk_MB);
  options.library = library;
  return options;
}

RecordingThread::RecordingThread(const Config& config, std::optional<std::filesystem::path> file,
                                 FileExtras extras, std::function<void()> on_change)
    : config_(config),
      extras_(std::move(extras)),
      on_change_(std::move(on_change)),
      recent_(config.recent_s, Bytes(config.recent_MB)),
      flushed_ns_(MonotonicNow_ns()) {
  if (file) {
    files_ = std::make_unique<RecordingFiles>(std::move(*file), extras_,
                                              Splitting{Bytes(config.split_MB), config.split_s});
    state_.files = files_->files();
  }
  thread_ = std::thread([this] { Run(); });
}

RecordingThread::~RecordingThread() {
  try {
    Stop();
  } catch (const RunError&) {
    // A destructor cannot tell; whoever wants to know calls Stop().
  }
}

bool RecordingThread::Push(RecordedMessage message) {
  {
    const std::lock_guard lock(mutex_);
    const std::uint64_t waiting = state_.waiting_bytes + message.data.size();
    // One message larger than the limit may wait alone.
    const bool fits = waiting <= Bytes(config_.waiting_MB) || work_.messages.empty();
    if (!fits || !state_.error.empty() || work_.stop) return false;
    state_.waiting_bytes = waiting;
    work_.messages.push_back(std::move(message));
  }
  changed_.notify_one();
  return true;
}

void RecordingThread::SaveRecent(const std::filesystem::path& file, const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    work_.requests.push_back({file, reason});
  }
  changed_.notify_one();
}

void RecordingThread::Stop() {
  {
    const std::lock_guard lock(mutex_);
    work_.stop = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  if (!state_.error.empty()) throw RunError(state_.error);
}

RecordingThread::State RecordingThread::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

RecordingThread::Work RecordingThread::Wait() {
  std::unique_lock lock(mutex_);
  const auto any = [this] {
    return work_.stop || !work_.messages.empty() || !work_.requests.empty();
  };
  changed_.wait_for(lock, FromSeconds(config_.flush_s), any);
  Work taken;
  taken.messages.swap(work_.messages);
  taken.requests.swap(work_.requests);
  taken.stop = work_.stop;
  return taken;
}

void RecordingThread::Run() {
  bool running = true;
  while (running) {
    const Work work = Wait();
    running = !work.stop;
    try {
      WriteAll(work);
      if (work.stop && files_) files_->Close();
    } catch (const RunError& error) {
      Fail(error.what());
    }
    for (const Request& request : work.requests) WriteSnapshot(request);
  }
}

void RecordingThread::WriteAll(const Work& work) {
  std::uint64_t bytes = 0;
  const bool writes = files_ && state().error.empty();
  for (const RecordedMessage& message : work.messages) {
    recent_.Add(message);
    bytes += message.data.size();
    if (writes) files_->Write(message);
  }
  if (writes && NsToSeconds(MonotonicNow_ns() - flushed_ns_) >= config_.flush_s) {
    files_->Flush();
    flushed_ns_ = MonotonicNow_ns();
  }
  const std::lock_guard lock(mutex_);
  state_.waiting_bytes -= bytes;
  state_.recent_s = recent_.shortest_s();
  state_.recent_slot_s = recent_.slot_s();
  if (!writes) return;
  state_.files = files_->files();
  state_.written_bytes = files_->size();
}

void RecordingThread::Fail(const std::string& error) {
  try {
    files_->Close();
  } catch (const RunError&) {
    // The first error says why. The file ends with a whole chunk.
  }
  {
    const std::lock_guard lock(mutex_);
    if (state_.error.empty()) state_.error = error;
    state_.waiting_bytes = 0;
    work_.messages.clear();
  }
  if (on_change_) on_change_();
}

void RecordingThread::WriteSnapshot(const Request& request) {
  FileExtras extras = extras_;
  extras.metadata.push_back(
      {"snapshot", {{"reason", request.reason}, {"seconds", FormatNumber(config_.recent_s)}}});
  try {
    RecordingFile file(request.file, extras);
    for (const RecordedMessage& message : recent_.Snapshot()) file.Write(message);
    file.Close();
    if (!request.reason.empty()) {
      std::filesystem::path text = request.file;
      WriteFile(text.replace_extension(".txt"), request.reason + "\n");
    }
    const std::lock_guard lock(mutex_);
    state_.snapshots.push_back(request.file);
  } catch (const RunError& error) {
    const std::lock_guard lock(mutex_);
    if (state_.error.empty()) state_.error = error.what();
  }
  if (on_change_) on_change_();
}

}  // namespace palpate::recorder
