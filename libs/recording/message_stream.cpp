// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/message_stream.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "libs/recording/record_walk.hpp"

namespace palpate::recording {

struct MessageStream::OpenBlock {
  struct Entry {
    std::int64_t time_ns;
    std::uint64_t offset;  ///< of the record's content
    std::uint64_t size;
  };

  std::uint64_t offset = 0;  ///< in the file
  std::string records;
  std::vector<Entry> entries;
  std::size_t next = 0;

  bool at_end() const { return next == entries.size(); }
  std::pair<std::int64_t, std::uint64_t> order() const { return {entries[next].time_ns, offset}; }
};

namespace {

constexpr auto kLater = [](const auto& a, const auto& b) { return a->order() > b->order(); };

}  // namespace

MessageStream::MessageStream(const InputFile& file, const Contents& contents,
                             const MessageFilter& filter)
    : file_(&file),
      contents_(&contents),
      filter_(filter),
      channels_(std::numeric_limits<std::uint16_t>::max() + std::size_t{1}, !filter.wanted) {
  for (const auto& [id, channel] : contents.channels) {
    channels_[id] = !filter.wanted || filter.wanted(channel);
  }
  for (std::size_t i = 0; i < contents.blocks.size(); ++i) {
    if (IsWanted(contents.blocks[i])) waiting_.push_back(i);
  }
  const auto order = [&](std::size_t i) {
    return std::pair(contents.blocks[i].start_time_ns, contents.blocks[i].offset);
  };
  std::sort(waiting_.begin(), waiting_.end(),
            [&](std::size_t a, std::size_t b) { return order(a) > order(b); });
}

MessageStream::~MessageStream() = default;
MessageStream::MessageStream(MessageStream&&) noexcept = default;
MessageStream& MessageStream::operator=(MessageStream&&) noexcept = default;

bool MessageStream::IsWanted(const Block& block) const {
  if (block.end_time_ns < filter_.start_time_ns || block.start_time_ns > filter_.end_time_ns) {
    return false;
  }
  if (!block.channels) return true;
  return std::any_of(block.channels->begin(), block.channels->end(),
                     [&](std::uint16_t id) { return channels_[id]; });
}

void MessageStream::Open(std::size_t index) {
  const Block& block = contents_->blocks[index];
  auto opened = std::make_unique<OpenBlock>();
  opened->offset = block.offset;
  std::string cause;
  if (!ReadBlock(*file_, block, &opened->records, &cause)) {
    problems_.push_back("byte " + std::to_string(block.offset) + ": chunk: " + cause);
    return;
  }
  const auto add = [&](Opcode opcode, std::string_view content, std::uint64_t) {
    Message message;
    if (opcode != Opcode::kMessage || !Get(content, &message)) return;
    const bool in_time =
        message.log_time_ns >= filter_.start_time_ns && message.log_time_ns <= filter_.end_time_ns;
    if (!in_time || !channels_[message.channel_id]) return;
    const auto offset = static_cast<std::uint64_t>(content.data() - opened->records.data());
    opened->entries.push_back({message.log_time_ns, offset, content.size()});
  };
  if (!ForEachRecord(opened->records, add)) {
    problems_.push_back("byte " + std::to_string(block.offset) + ": its last record is cut");
  }
  if (opened->entries.empty()) return;
  std::stable_sort(opened->entries.begin(), opened->entries.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  open_.push_back(std::move(opened));
  std::push_heap(open_.begin(), open_.end(), kLater);
}

const Message* MessageStream::Next() {
  if (current_ && !current_->at_end()) {
    open_.push_back(std::move(current_));
    std::push_heap(open_.begin(), open_.end(), kLater);
  }
  current_.reset();
  // A block that is not open yet may hold a message that comes before those of the open ones.
  while (!waiting_.empty()) {
    const std::size_t index = waiting_.back();
    const Block& block = contents_->blocks[index];
    if (!open_.empty() && std::pair(block.start_time_ns, block.offset) > open_.front()->order()) {
      break;
    }
    waiting_.pop_back();
    Open(index);
  }
  if (open_.empty()) return nullptr;
  std::pop_heap(open_.begin(), open_.end(), kLater);
  current_ = std::move(open_.back());
  open_.pop_back();
  const OpenBlock::Entry& entry = current_->entries[current_->next++];
  const std::string_view records(current_->records);
  return Get(records.substr(entry.offset, entry.size), &message_) ? &message_ : nullptr;
}

}  // namespace palpate::recording
