// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/repair.hpp"

#include <map>
#include <memory>

#include "libs/recording/record_walk.hpp"
#include "libs/recording/writer.hpp"

namespace palpate::recording {

namespace {

Compression CompressionOf(const InputFile& file, const Contents& contents) {
  ChunkHead head;
  std::string_view records;
  for (const Block& block : contents.blocks) {
    const std::string bytes = file.Read(block.offset, block.length);
    if (!block.is_chunk ||
        !GetChunk(std::string_view(bytes).substr(kRecordPrefix), &head, &records)) {
      continue;
    }
    for (const Compression known : {Compression::kZstd, Compression::kLz4}) {
      if (head.compression == McapName(known)) return known;
    }
    break;
  }
  return Compression::kNone;
}

/// The channels of one file as another has them.
class ChannelMap {
 public:
  ChannelMap(const Contents& contents, Writer* writer) : contents_(contents), writer_(*writer) {}

  /// nullptr: the channel's own record is lost, so nobody knows what the message is.
  const std::uint16_t* Of(std::uint16_t id) {
    if (const auto known = ids_.find(id); known != ids_.end()) return &known->second;
    const auto channel = contents_.channels.find(id);
    if (channel == contents_.channels.end()) return nullptr;
    Channel copy = channel->second;
    const auto schema = contents_.schemas.find(copy.schema_id);
    copy.schema_id = 0;
    if (schema != contents_.schemas.end()) {
      const Schema& found = schema->second;
      copy.schema_id = writer_.AddSchema(found.name, found.encoding, found.data);
    }
    return &(ids_[id] = writer_.AddChannel(std::move(copy)));
  }

 private:
  const Contents& contents_;
  Writer& writer_;
  std::map<std::uint16_t, std::uint16_t> ids_;
};

std::uint64_t CopyMessages(const InputFile& file, const Contents& contents, Writer* writer,
                           std::vector<std::string>* problems) {
  ChannelMap channels(contents, writer);
  for (const auto& [id, channel] : contents.channels) channels.Of(id);
  std::uint64_t count = 0;
  std::uint64_t unknown = 0;
  std::string records;
  std::string cause;
  for (const Block& block : contents.blocks) {
    if (!ReadBlock(file, block, &records, &cause)) {
      problems->push_back("byte " + std::to_string(block.offset) + ": chunk: " + cause);
      continue;
    }
    const auto copy = [&](Opcode opcode, std::string_view content, std::uint64_t) {
      Message message;
      if (opcode != Opcode::kMessage || !Get(content, &message)) return;
      const std::uint16_t* id = channels.Of(message.channel_id);
      ++(id == nullptr ? unknown : count);
      if (id == nullptr) return;
      message.channel_id = *id;
      writer->Write(message);
    };
    // Scan() has already named a record that is cut.
    [[maybe_unused]] const bool whole = ForEachRecord(records, copy);
  }
  if (unknown > 0) {
    problems->push_back(std::to_string(unknown) + " messages of channels that are lost");
  }
  return count;
}

}  // namespace

RepairResult Repair(const std::filesystem::path& damaged, const std::filesystem::path& repaired) {
  const Reader reader(damaged);
  const InputFile file(damaged);
  const Contents contents = Scan(file);
  RepairResult result;
  result.problems = contents.problems;
  Writer writer(std::make_unique<OutputFile>(repaired),
                {.compression = CompressionOf(file, contents),
                 .profile = contents.header.profile,
                 .library = contents.header.library});
  for (const MetadataIndex& index : contents.metadata) writer.Write(reader.Read(index));
  for (const AttachmentIndex& index : contents.attachments) writer.Write(reader.Read(index));
  result.messages = CopyMessages(file, contents, &writer, &result.problems);
  writer.Close();
  return result;
}

}  // namespace palpate::recording
