// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/writer.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/recording/bytes.hpp"
#include "libs/recording/crc.hpp"

namespace palpate::recording {

namespace {

/// A message of this size ends its chunk: its bytes need not be copied then, which is a good part
/// of what recording images costs.
constexpr std::size_t kUncopiedBytes = std::size_t{1} << 18;

std::uint16_t NextId(std::size_t count, const std::string& what) {
  if (count >= std::numeric_limits<std::uint16_t>::max()) {
    throw RunError("the recording has 65535 " + what + ", and MCAP has no number for one more");
  }
  return static_cast<std::uint16_t>(count + 1);
}

/// Records of one kind in the summary, and the record that says where they are.
class SummaryGroups {
 public:
  explicit SummaryGroups(std::uint64_t start) : start_(start) {}

  template <typename Record>
  void Add(Opcode opcode, const std::vector<Record>& group) {
    const std::uint64_t before = records_.size();
    for (const Record& record : group) Put(record, &records_);
    if (records_.size() == before) return;
    std::string content;
    ByteWriter writer(&content);
    writer.Put(opcode);
    writer.Put(start_ + before);
    writer.Put(records_.size() - before);
    PutRecord(Opcode::kSummaryOffset, content, &offsets_);
  }

  /// All of it with the footer and the closing magic.
  std::string Finished() && {
    const std::uint64_t offset_start = start_ + records_.size();
    std::string bytes = std::move(records_) + offsets_;
    ByteWriter writer(&bytes);
    writer.Put(Opcode::kFooter);
    writer.Put(std::uint64_t{kFooterSize - kRecordPrefix});
    writer.Put(start_);
    writer.Put(offset_start);
    writer.Put(Crc32(bytes));
    writer.Raw(kMagic);
    return bytes;
  }

 private:
  std::uint64_t start_;
  std::string records_;
  std::string offsets_;
};

void PutMessageIndex(std::uint16_t channel_id,
                     const std::vector<std::pair<std::int64_t, std::uint64_t>>& entries,
                     std::string* out) {
  std::string content;
  ByteWriter writer(&content);
  writer.Put(channel_id);
  writer.Put(static_cast<std::uint32_t>(entries.size() * 2 * sizeof(std::uint64_t)));
  for (const auto& [time_ns, offset] : entries) {
    writer.Put(time_ns);
    writer.Put(offset);
  }
  PutRecord(Opcode::kMessageIndex, content, out);
}

}  // namespace

Writer::Writer(std::unique_ptr<Output> output, const WriterOptions& options)
    : output_(std::move(output)),
      options_(options),
      compressor_(options.compression, options.zstd_level) {
  std::string start(kMagic);
  Put(FileHeader{options.profile, options.library}, &start);
  Append(start);
}

Writer::~Writer() {
  try {
    Close();
  } catch (const RunError&) {
    // A destructor cannot tell; whoever wants to know calls Close().
  }
}

void Writer::Append(std::string_view bytes, std::optional<std::uint32_t> crc) {
  output_->Append(bytes);
  position_ += bytes.size();
  crc_ = crc ? CombinedCrc32(crc_, *crc, bytes.size()) : Crc32(bytes, crc_);
}

/// What is written in part is cut off again, so that the file has whole records only.
template <typename Action>
void Writer::AllOrNothing(const Action& action) {
  const std::uint64_t position = position_;
  const std::uint32_t crc = crc_;
  try {
    action();
  } catch (const RunError&) {
    output_->Truncate(position);
    position_ = position;
    crc_ = crc;
    throw;
  }
}

std::uint16_t Writer::AddSchema(const std::string& name, const std::string& encoding,
                                const std::string& data) {
  for (const Schema& known : schemas_) {
    if (known.name == name && known.encoding == encoding && known.data == data) return known.id;
  }
  const Schema schema{NextId(schemas_.size(), "schemas"), name, encoding, data};
  std::string record;
  Put(schema, &record);
  AllOrNothing([&] { Append(record); });
  schemas_.push_back(schema);
  ++statistics_.schema_count;
  return schema.id;
}

std::uint16_t Writer::AddChannel(Channel channel) {
  for (const Channel& known : channels_) {
    const bool equal = known.topic == channel.topic && known.schema_id == channel.schema_id &&
                       known.message_encoding == channel.message_encoding &&
                       known.metadata == channel.metadata;
    if (equal) return known.id;
  }
  PALPATE_CHECK(channel.schema_id <= schemas_.size(), channel.topic, channel.schema_id);
  channel.id = NextId(channels_.size(), "channels");
  // Outside the chunks: a chunk that is damaged takes no channel of another one with it.
  std::string record;
  Put(channel, &record);
  AllOrNothing([&] { Append(record); });
  channels_.push_back(channel);
  ++statistics_.channel_count;
  return channel.id;
}

void Writer::Write(const Message& message) {
  PALPATE_CHECK(message.channel_id > 0 && message.channel_id <= channels_.size(),
                message.channel_id);
  PALPATE_CHECK(!closed_);
  if (!chunk_.empty() && chunk_.size() + message.data.size() > options_.chunk_bytes) WriteChunk();
  const bool first = chunk_.empty();
  chunk_start_ns_ = first ? message.log_time_ns : std::min(chunk_start_ns_, message.log_time_ns);
  chunk_end_ns_ = first ? message.log_time_ns : std::max(chunk_end_ns_, message.log_time_ns);
  chunk_messages_[message.channel_id].emplace_back(message.log_time_ns, chunk_.size());
  if (options_.compression == Compression::kNone && message.data.size() >= kUncopiedBytes) {
    PutMessageHead(message, &chunk_);
    WriteChunk(message.data);
    return;
  }
  Put(message, &chunk_);
  if (chunk_.size() >= options_.chunk_bytes) WriteChunk();
}

void Writer::Write(const Attachment& attachment) {
  PALPATE_CHECK(!closed_);
  std::string record;
  Put(attachment, &record);
  const std::uint64_t offset = position_;
  AllOrNothing([&] { Append(record); });
  attachment_indexes_.push_back({offset, record.size(), attachment.log_time_ns,
                                 attachment.create_time_ns, attachment.data.size(), attachment.name,
                                 attachment.media_type});
  ++statistics_.attachment_count;
}

void Writer::Write(const Metadata& metadata) {
  PALPATE_CHECK(!closed_);
  std::string record;
  Put(metadata, &record);
  const std::uint64_t offset = position_;
  AllOrNothing([&] { Append(record); });
  metadata_indexes_.push_back({offset, record.size(), metadata.name});
  ++statistics_.metadata_count;
}

void Writer::Flush() {
  if (!chunk_.empty()) WriteChunk();
}

void Writer::WriteChunk(std::string_view data) {
  const std::uint32_t chunk_crc = Crc32(chunk_);
  const std::uint32_t data_crc = Crc32(data);
  const std::uint32_t crc = CombinedCrc32(chunk_crc, data_crc, data.size());
  const Compressor::Packed packed = compressor_.Pack(chunk_);
  const bool is_plain = packed.compression == Compression::kNone;
  const std::uint64_t uncompressed_size = chunk_.size() + data.size();
  std::string head;
  PutChunkHead({chunk_start_ns_, chunk_end_ns_, uncompressed_size, crc,
                std::string(McapName(packed.compression)), packed.bytes.size() + data.size()},
               &head);
  ChunkIndex index = IndexOf(packed, head.size(), uncompressed_size);
  index.length += data.size();
  index.compressed_size += data.size();
  std::string message_indexes;
  for (const auto& [channel_id, entries] : chunk_messages_) {
    index.message_index_offsets[channel_id] = index.offset + index.length + message_indexes.size();
    PutMessageIndex(channel_id, entries, &message_indexes);
  }
  index.message_index_length = message_indexes.size();
  try {
    AllOrNothing([&] {
      Append(head);
      Append(packed.bytes, is_plain ? std::optional(chunk_crc) : std::nullopt);
      if (!data.empty()) Append(data, data_crc);
      Append(message_indexes);
    });
  } catch (const RunError&) {
    chunk_.clear();
    chunk_messages_.clear();
    throw;
  }
  chunk_indexes_.push_back(std::move(index));
  CountChunk();
}

ChunkIndex Writer::IndexOf(const Compressor::Packed& packed, std::uint64_t head_size,
                           std::uint64_t uncompressed_size) const {
  return {.start_time_ns = chunk_start_ns_,
          .end_time_ns = chunk_end_ns_,
          .offset = position_,
          .length = head_size + packed.bytes.size(),
          .message_index_offsets = {},
          .message_index_length = 0,
          .compression = std::string(McapName(packed.compression)),
          .compressed_size = packed.bytes.size(),
          .uncompressed_size = uncompressed_size};
}

void Writer::CountChunk() {
  const bool first = statistics_.message_count == 0;
  Statistics& s = statistics_;
  s.start_time_ns = first ? chunk_start_ns_ : std::min(s.start_time_ns, chunk_start_ns_);
  s.end_time_ns = first ? chunk_end_ns_ : std::max(s.end_time_ns, chunk_end_ns_);
  for (const auto& [channel_id, entries] : chunk_messages_) {
    s.channel_message_counts[channel_id] += entries.size();
    s.message_count += entries.size();
  }
  ++s.chunk_count;
  chunk_.clear();
  chunk_messages_.clear();
}

void Writer::Close() {
  if (closed_) return;
  std::string failure;
  try {
    Flush();
  } catch (const RunError& error) {
    failure = error.what();  // The place that the chunk leaves may do for the index.
  }
  closed_ = true;
  AllOrNothing([&] {
    std::string end;
    ByteWriter writer(&end);
    writer.Put(Opcode::kDataEnd);
    writer.Put(std::uint64_t{sizeof(crc_)});
    writer.Put(crc_);
    Append(end);
    Append(Summary(position_));
  });
  output_->Close();
  if (!failure.empty()) throw RunError(failure);
}

std::string Writer::Summary(std::uint64_t summary_start) const {
  SummaryGroups groups(summary_start);
  groups.Add(Opcode::kSchema, schemas_);
  groups.Add(Opcode::kChannel, channels_);
  groups.Add(Opcode::kStatistics, std::vector<Statistics>{statistics_});
  groups.Add(Opcode::kChunkIndex, chunk_indexes_);
  groups.Add(Opcode::kAttachmentIndex, attachment_indexes_);
  groups.Add(Opcode::kMetadataIndex, metadata_indexes_);
  return std::move(groups).Finished();
}

}  // namespace palpate::recording
