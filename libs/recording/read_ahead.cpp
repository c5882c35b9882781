// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/read_ahead.hpp"

#include <string_view>
#include <utility>

namespace palpate::recording {

void ReadAhead::Batch::Clear() {
  messages.clear();
  ends.clear();
  bytes.clear();
}

void ReadAhead::Batch::Add(const Message& message) {
  bytes += message.data;
  messages.push_back(message);
  messages.back().data = {};
  ends.push_back(bytes.size());
}

ReadAhead::ReadAhead(RecordedStream stream) : stream_(std::move(stream)) {
  thread_ = std::thread([this] { Read(); });
}

ReadAhead::~ReadAhead() {
  batches_.Stop();
  thread_.join();
}

void ReadAhead::Read() {
  bool go_on = true;
  while (go_on) {
    Batch batch = used_.TryPop().value_or(Batch());
    batch.Clear();
    try {
      batch.is_last = !Fill(&batch);
    } catch (...) {
      batch.is_last = true;
      batch.error = std::current_exception();
    }
    go_on = !batch.is_last;
    go_on = batches_.PushWhenRoom(std::move(batch)) && go_on;
  }
}

/// False at the end of the recording.
bool ReadAhead::Fill(Batch* batch) {
  while (batch->bytes.size() < kBatchBytes) {
    const Message* message = stream_.Next();
    if (message == nullptr) return false;
    batch->Add(*message);
  }
  return true;
}

const Message* ReadAhead::Next() {
  while (!current_ || next_ == current_->messages.size()) {
    if (current_ && current_->is_last) {
      if (current_->error) std::rethrow_exception(current_->error);
      return nullptr;
    }
    if (current_) used_.Push(std::move(*current_), false);
    current_ = batches_.Pop();
    next_ = 0;
  }
  const std::size_t begin = next_ == 0 ? 0 : current_->ends[next_ - 1];
  message_ = current_->messages[next_];
  message_.data = std::string_view(current_->bytes).substr(begin, current_->ends[next_] - begin);
  ++next_;
  return &message_;
}

}  // namespace palpate::recording
