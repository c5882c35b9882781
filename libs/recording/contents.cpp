// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/contents.hpp"

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/recording/compression.hpp"
#include "libs/recording/crc.hpp"
#include "libs/recording/record_walk.hpp"

namespace palpate::recording {

namespace {

/// Messages outside chunks are read in stretches of this size.
constexpr std::uint64_t kLooseBlockBytes = std::uint64_t{4} << 20;

template <typename Record>
void Keep(std::string_view content, std::map<std::uint16_t, Record>* records) {
  Record record;
  if (Get(content, &record)) records->insert_or_assign(record.id, std::move(record));
}

template <typename Record>
void Keep(std::string_view content, std::vector<Record>* records) {
  Record record;
  if (Get(content, &record)) records->push_back(std::move(record));
}

Block BlockOf(const ChunkIndex& index) {
  Block block{.is_chunk = true,
              .offset = index.offset,
              .length = index.length,
              .start_time_ns = index.start_time_ns,
              .end_time_ns = index.end_time_ns,
              .channels = {}};
  if (index.message_index_offsets.empty()) return block;
  block.channels.emplace();
  for (const auto& [channel_id, offset] : index.message_index_offsets) {
    block.channels->insert(channel_id);
  }
  return block;
}

bool FindFooter(const InputFile& file, Footer* footer) {
  if (file.size() < kFooterSize + 2 * kMagic.size()) return false;
  const std::uint64_t offset = file.size() - kMagic.size() - kFooterSize;
  const std::string bytes = file.Read(offset, kFooterSize + kMagic.size());
  if (!bytes.ends_with(kMagic) || bytes[0] != static_cast<char>(Opcode::kFooter)) return false;
  if (!Get(std::string_view(bytes).substr(kRecordPrefix, kFooterSize - kRecordPrefix), footer)) {
    return false;
  }
  return footer->summary_start >= kMagic.size() && footer->summary_start < offset;
}

/// Goes through a file that may be cut or damaged.
class Scanner {
 public:
  explicit Scanner(const InputFile& file) : file_(file) {}

  Contents Run() && {
    offset_ = kMagic.size();
    while (!at_end_ && offset_ < file_.size()) ReadRecord();
    EndLooseBlock();
    Footer footer;
    if (!FindFooter(file_, &footer)) {
      found_.problems.push_back("no index at its end: the recording was cut off, or still runs");
    }
    CountAll();
    return std::move(found_);
  }

 private:
  void ReadRecord() {
    const std::string prefix = file_.Read(offset_, kRecordPrefix);
    ByteReader reader(prefix);
    const auto opcode = reader.Get<Opcode>();
    const auto length = reader.Get<std::uint64_t>();
    const std::uint64_t left = file_.size() - offset_;
    if (!reader.ok() || length > left - kRecordPrefix) {
      found_.problems.push_back("byte " + std::to_string(offset_) + ": the last " +
                                std::to_string(left) + " bytes are no whole record");
      offset_ = file_.size();
      return;
    }
    const bool is_message = opcode == Opcode::kMessage;
    if (!is_message) EndLooseBlock();
    Take(opcode, length);
    offset_ += kRecordPrefix + length;
    if (is_message && loose_.length >= kLooseBlockBytes) EndLooseBlock();
  }

  void Take(Opcode opcode, std::uint64_t length) {
    const auto content = [&] { return file_.Read(offset_ + kRecordPrefix, length); };
    switch (opcode) {
      case Opcode::kHeader:
        if (!Get(content(), &found_.header)) Damaged("header");
        break;
      case Opcode::kSchema: Keep(content(), &found_.schemas); break;
      case Opcode::kChannel: Keep(content(), &found_.channels); break;
      case Opcode::kMessage: TakeLoose(content(), length); break;
      case Opcode::kChunk: TakeChunk(length); break;
      case Opcode::kAttachment: TakeAttachment(content()); break;
      case Opcode::kMetadata: TakeMetadata(content()); break;
      case Opcode::kDataEnd: at_end_ = true; break;
      default: break;  // indexes, and what later versions of MCAP may have
    }
  }

  void Damaged(const std::string& what, const std::string& cause = "too short") {
    found_.problems.push_back("byte " + std::to_string(offset_) + ": " + what + ": " + cause);
  }

  void TakeLoose(std::string_view content, std::uint64_t length) {
    Message message;
    if (!Get(content, &message)) return Damaged("message");
    if (loose_.length == 0) {
      loose_ = {.is_chunk = false,
                .offset = offset_,
                .length = 0,
                .start_time_ns = message.log_time_ns,
                .end_time_ns = message.log_time_ns,
                .channels = std::set<std::uint16_t>()};
    }
    loose_.length += kRecordPrefix + length;
    Count(message, &loose_);
  }

  void EndLooseBlock() {
    if (loose_.length > 0) found_.blocks.push_back(loose_);
    loose_ = {};
  }

  void Count(const Message& message, Block* block) {
    block->start_time_ns = std::min(block->start_time_ns, message.log_time_ns);
    block->end_time_ns = std::max(block->end_time_ns, message.log_time_ns);
    block->channels->insert(message.channel_id);
    ++found_.statistics.channel_message_counts[message.channel_id];
  }

  void TakeChunk(std::uint64_t length) {
    Block block{.is_chunk = true,
                .offset = offset_,
                .length = kRecordPrefix + length,
                .start_time_ns = 0,
                .end_time_ns = 0,
                .channels = std::set<std::uint16_t>()};
    std::string records;
    std::string cause;
    if (!ReadBlock(file_, block, &records, &cause)) return Damaged("chunk", cause);
    bool first = true;
    const bool whole = ForEachRecord(records, [&](Opcode opcode, std::string_view content, auto) {
      if (opcode == Opcode::kSchema) Keep(content, &found_.schemas);
      if (opcode == Opcode::kChannel) Keep(content, &found_.channels);
      Message message;
      if (opcode != Opcode::kMessage || !Get(content, &message)) return;
      if (first) block.start_time_ns = block.end_time_ns = message.log_time_ns;
      first = false;
      Count(message, &block);
    });
    if (!whole) Damaged("chunk", "its last record is cut");
    ++found_.statistics.chunk_count;
    if (!first) found_.blocks.push_back(std::move(block));
  }

  void TakeAttachment(std::string_view content) {
    Attachment attachment;
    if (!Get(content, &attachment)) return Damaged("attachment", "its CRC differs");
    found_.attachments.push_back({offset_, kRecordPrefix + content.size(), attachment.log_time_ns,
                                  attachment.create_time_ns, attachment.data.size(),
                                  attachment.name, attachment.media_type});
  }

  void TakeMetadata(std::string_view content) {
    Metadata metadata;
    if (!Get(content, &metadata)) return Damaged("metadata");
    found_.metadata.push_back({offset_, kRecordPrefix + content.size(), metadata.name});
  }

  void CountAll() {
    Statistics& s = found_.statistics;
    for (const auto& [channel_id, count] : s.channel_message_counts) s.message_count += count;
    s.schema_count = static_cast<std::uint16_t>(found_.schemas.size());
    s.channel_count = static_cast<std::uint32_t>(found_.channels.size());
    s.attachment_count = static_cast<std::uint32_t>(found_.attachments.size());
    s.metadata_count = static_cast<std::uint32_t>(found_.metadata.size());
    if (found_.blocks.empty()) return;
    s.start_time_ns = found_.blocks.front().start_time_ns;
    s.end_time_ns = found_.blocks.front().end_time_ns;
    for (const Block& block : found_.blocks) {
      s.start_time_ns = std::min(s.start_time_ns, block.start_time_ns);
      s.end_time_ns = std::max(s.end_time_ns, block.end_time_ns);
    }
  }

  const InputFile& file_;
  std::uint64_t offset_ = 0;
  bool at_end_ = false;
  Contents found_;
  Block loose_;
};

}  // namespace

void CheckMagic(const InputFile& file) {
  if (file.Read(0, kMagic.size()) == kMagic) return;
  throw InputError({file.path().string()},
                   "is no MCAP recording: it does not begin with MCAP's 8 bytes");
}

bool IsMcap(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  try {
    return InputFile(file).Read(0, kMagic.size()) == kMagic;
  } catch (const InputError&) {
    return false;
  }
}

std::optional<Contents> ReadSummary(const InputFile& file) {
  Footer footer;
  if (!FindFooter(file, &footer)) return std::nullopt;
  const std::uint64_t end = file.size() - kMagic.size();
  const std::string bytes = file.Read(footer.summary_start, end - footer.summary_start);
  const std::string_view covered(bytes.data(), bytes.size() - sizeof(footer.summary_crc));
  if (footer.summary_crc != 0 && footer.summary_crc != Crc32(covered)) return std::nullopt;
  Contents contents;
  contents.indexed = true;
  bool counted = false;
  const bool whole = ForEachRecord(bytes, [&](Opcode opcode, std::string_view content, auto) {
    ChunkIndex chunk;
    switch (opcode) {
      case Opcode::kSchema: Keep(content, &contents.schemas); break;
      case Opcode::kChannel: Keep(content, &contents.channels); break;
      case Opcode::kAttachmentIndex: Keep(content, &contents.attachments); break;
      case Opcode::kMetadataIndex: Keep(content, &contents.metadata); break;
      case Opcode::kStatistics: counted = Get(content, &contents.statistics); break;
      case Opcode::kChunkIndex:
        if (Get(content, &chunk)) contents.blocks.push_back(BlockOf(chunk));
        break;
      default: break;
    }
  });
  const bool unchunked = contents.blocks.empty() && contents.statistics.message_count > 0;
  if (!whole || !counted || unchunked) return std::nullopt;
  const std::string start = file.Read(kMagic.size(), kRecordPrefix);
  ByteReader reader(std::string_view(start).substr(1));
  const auto length = reader.Get<std::uint64_t>();
  if (length > file.size() ||
      !Get(file.Read(kMagic.size() + kRecordPrefix, length), &contents.header)) {
    return std::nullopt;
  }
  return contents;
}

Contents Scan(const InputFile& file) {
  CheckMagic(file);
  return Scanner(file).Run();
}

bool ReadBlock(const InputFile& file, const Block& block, std::string* records,
               std::string* cause) {
  std::string bytes = file.Read(block.offset, block.length);
  if (bytes.size() != block.length) {
    *cause = "the file ends before it";
    return false;
  }
  if (!block.is_chunk) {
    *records = std::move(bytes);
    return true;
  }
  ChunkHead head;
  std::string_view packed;
  const bool is_chunk = bytes.size() > kRecordPrefix &&
                        bytes[0] == static_cast<char>(Opcode::kChunk) &&
                        GetChunk(std::string_view(bytes).substr(kRecordPrefix), &head, &packed);
  if (!is_chunk) {
    *cause = "is no whole chunk";
    return false;
  }
  if (!Unpack(head.compression, packed, head.uncompressed_size, records, cause)) return false;
  if (head.uncompressed_crc == 0 || head.uncompressed_crc == Crc32(*records)) return true;
  *cause = "its CRC differs";
  return false;
}

}  // namespace palpate::recording
