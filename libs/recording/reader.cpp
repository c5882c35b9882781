// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/reader.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::recording {

namespace {

Contents ContentsOf(const InputFile& file) {
  CheckMagic(file);
  std::optional<Contents> summary = ReadSummary(file);
  return summary ? std::move(*summary) : Scan(file);
}

template <typename Record, typename Index>
Record ReadIndexed(const InputFile& file, Opcode opcode, const Index& index) {
  Record record;
  const std::string bytes = file.Read(index.offset, index.length);
  const bool whole = bytes.size() == index.length && bytes.size() > kRecordPrefix &&
                     bytes[0] == static_cast<char>(opcode) &&
                     Get(std::string_view(bytes).substr(kRecordPrefix), &record);
  if (whole) return record;
  throw InputError({file.path().string()},
                   "'" + index.name + "' at byte " + std::to_string(index.offset) + " is damaged");
}

}  // namespace

Reader::Reader(const std::filesystem::path& file)
    : file_(std::make_unique<InputFile>(file)), contents_(ContentsOf(*file_)) {}

const Schema& Reader::SchemaOf(const Channel& channel) const {
  static const Schema kNone;
  const auto found = contents_.schemas.find(channel.schema_id);
  return found == contents_.schemas.end() ? kNone : found->second;
}

MessageStream Reader::Messages(const MessageFilter& filter) const {
  return {*file_, contents_, filter};
}

std::vector<StoredMessage> Reader::NewestBefore(
    std::int64_t time_ns, const std::function<bool(const Channel&)>& wanted) const {
  std::set<std::uint16_t> missing;
  for (const auto& [id, channel] : contents_.channels) {
    if (wanted(channel)) missing.insert(id);
  }
  std::vector<Block> blocks = contents_.blocks;
  std::stable_sort(blocks.begin(), blocks.end(),
                   [](const Block& a, const Block& b) { return a.end_time_ns > b.end_time_ns; });
  std::map<std::uint16_t, StoredMessage> newest;
  for (const Block& block : blocks) {
    // No block from here on has anything newer than what was found.
    std::erase_if(missing, [&](std::uint16_t id) {
      const auto found = newest.find(id);
      return found != newest.end() && found->second.message.log_time_ns > block.end_time_ns;
    });
    if (missing.empty()) break;
    Contents one;
    one.channels = contents_.channels;
    one.blocks = {block};
    MessageFilter filter;
    filter.end_time_ns = time_ns;
    filter.wanted = [&](const Channel& channel) { return missing.contains(channel.id); };
    MessageStream stream(*file_, one, filter);
    while (const Message* message = stream.Next()) {
      StoredMessage& kept = newest[message->channel_id];
      if (!kept.data.empty() && message->log_time_ns < kept.message.log_time_ns) continue;
      kept = {*message, std::string(message->data)};
      kept.message.data = {};
    }
  }
  std::vector<StoredMessage> messages;
  for (auto& [id, message] : newest) messages.push_back(std::move(message));
  return messages;
}

Attachment Reader::Read(const AttachmentIndex& index) const {
  return ReadIndexed<Attachment>(*file_, Opcode::kAttachment, index);
}

Metadata Reader::Read(const MetadataIndex& index) const {
  return ReadIndexed<Metadata>(*file_, Opcode::kMetadata, index);
}

}  // namespace palpate::recording
