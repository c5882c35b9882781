// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/records.hpp"

#include "libs/recording/bytes.hpp"
#include "libs/recording/crc.hpp"

namespace palpate::recording {

namespace {

/// Begins a record, and sets its length once its content is there.
class OpenRecord {
 public:
  OpenRecord(Opcode opcode, std::string* out) : out_(*out), writer_(out) {
    writer_.Put(opcode);
    writer_.Put(std::uint64_t{0});
    start_ = out_.size();
  }
  ~OpenRecord() {
    const std::uint64_t length = out_.size() - start_;
    std::memcpy(out_.data() + start_ - sizeof(length), &length, sizeof(length));
  }
  OpenRecord(const OpenRecord&) = delete;
  OpenRecord& operator=(const OpenRecord&) = delete;

  ByteWriter* operator->() { return &writer_; }
  std::string_view content() const { return std::string_view(out_).substr(start_); }

 private:
  std::string& out_;
  ByteWriter writer_;
  std::size_t start_ = 0;
};

using Numbers = std::map<std::uint16_t, std::uint64_t>;
/// Channel, sequence and two times.
constexpr std::uint64_t kMessageHead = 2 + 4 + 8 + 8;
constexpr std::uint32_t kNumberSize = sizeof(std::uint16_t) + sizeof(std::uint64_t);

void PutNumbers(const Numbers& numbers, OpenRecord& record) {
  record->Put(static_cast<std::uint32_t>(numbers.size() * kNumberSize));
  for (const auto& [key, value] : numbers) {
    record->Put(key);
    record->Put(value);
  }
}

bool GetNumbers(ByteReader& reader, Numbers* numbers) {
  ByteReader inner(reader.Raw(reader.Get<std::uint32_t>()));
  while (inner.left() > 0 && inner.ok()) {
    const auto key = inner.Get<std::uint16_t>();
    (*numbers)[key] = inner.Get<std::uint64_t>();
  }
  return reader.ok() && inner.ok();
}

}  // namespace

void PutRecord(Opcode opcode, std::string_view content, std::string* out) {
  OpenRecord(opcode, out)->Raw(content);
}

void Put(const FileHeader& header, std::string* out) {
  OpenRecord record(Opcode::kHeader, out);
  record->Text(header.profile);
  record->Text(header.library);
}

void Put(const Schema& schema, std::string* out) {
  OpenRecord record(Opcode::kSchema, out);
  record->Put(schema.id);
  record->Text(schema.name);
  record->Text(schema.encoding);
  record->Text(schema.data);
}

void Put(const Channel& channel, std::string* out) {
  OpenRecord record(Opcode::kChannel, out);
  record->Put(channel.id);
  record->Put(channel.schema_id);
  record->Text(channel.topic);
  record->Text(channel.message_encoding);
  record->Map(channel.metadata);
}

void PutMessageHead(const Message& message, std::string* out) {
  ByteWriter writer(out);
  writer.Put(Opcode::kMessage);
  writer.Put(std::uint64_t{kMessageHead + message.data.size()});
  writer.Put(message.channel_id);
  writer.Put(message.sequence);
  writer.Put(message.log_time_ns);
  writer.Put(message.publish_time_ns);
}

void Put(const Message& message, std::string* out) {
  PutMessageHead(message, out);
  out->append(message.data);
}

void Put(const Attachment& attachment, std::string* out) {
  OpenRecord record(Opcode::kAttachment, out);
  record->Put(attachment.log_time_ns);
  record->Put(attachment.create_time_ns);
  record->Text(attachment.name);
  record->Text(attachment.media_type);
  record->Put(static_cast<std::uint64_t>(attachment.data.size()));
  record->Raw(attachment.data);
  record->Put(Crc32(record.content()));
}

void Put(const Metadata& metadata, std::string* out) {
  OpenRecord record(Opcode::kMetadata, out);
  record->Text(metadata.name);
  record->Map(metadata.values);
}

void Put(const ChunkIndex& index, std::string* out) {
  OpenRecord record(Opcode::kChunkIndex, out);
  record->Put(index.start_time_ns);
  record->Put(index.end_time_ns);
  record->Put(index.offset);
  record->Put(index.length);
  PutNumbers(index.message_index_offsets, record);
  record->Put(index.message_index_length);
  record->Text(index.compression);
  record->Put(index.compressed_size);
  record->Put(index.uncompressed_size);
}

void Put(const AttachmentIndex& index, std::string* out) {
  OpenRecord record(Opcode::kAttachmentIndex, out);
  record->Put(index.offset);
  record->Put(index.length);
  record->Put(index.log_time_ns);
  record->Put(index.create_time_ns);
  record->Put(index.data_size);
  record->Text(index.name);
  record->Text(index.media_type);
}

void Put(const MetadataIndex& index, std::string* out) {
  OpenRecord record(Opcode::kMetadataIndex, out);
  record->Put(index.offset);
  record->Put(index.length);
  record->Text(index.name);
}

void Put(const Statistics& statistics, std::string* out) {
  OpenRecord record(Opcode::kStatistics, out);
  record->Put(statistics.message_count);
  record->Put(statistics.schema_count);
  record->Put(statistics.channel_count);
  record->Put(statistics.attachment_count);
  record->Put(statistics.metadata_count);
  record->Put(statistics.chunk_count);
  record->Put(statistics.start_time_ns);
  record->Put(statistics.end_time_ns);
  PutNumbers(statistics.channel_message_counts, record);
}

void PutChunkHead(const ChunkHead& head, std::string* out) {
  const std::size_t start = out->size();
  {
    OpenRecord record(Opcode::kChunk, out);
    record->Put(head.start_time_ns);
    record->Put(head.end_time_ns);
    record->Put(head.uncompressed_size);
    record->Put(head.uncompressed_crc);
    record->Text(head.compression);
    record->Put(head.compressed_size);
  }
  const std::uint64_t length = out->size() - start - kRecordPrefix + head.compressed_size;
  std::memcpy(out->data() + start + 1, &length, sizeof(length));
}

bool Get(std::string_view content, FileHeader* header) {
  ByteReader reader(content);
  header->profile = reader.Text();
  header->library = reader.Text();
  return reader.ok();
}

bool Get(std::string_view content, Schema* schema) {
  ByteReader reader(content);
  schema->id = reader.Get<std::uint16_t>();
  schema->name = reader.Text();
  schema->encoding = reader.Text();
  schema->data = reader.Text();
  return reader.ok();
}

bool Get(std::string_view content, Channel* channel) {
  ByteReader reader(content);
  channel->id = reader.Get<std::uint16_t>();
  channel->schema_id = reader.Get<std::uint16_t>();
  channel->topic = reader.Text();
  channel->message_encoding = reader.Text();
  channel->metadata = reader.Map();
  return reader.ok();
}

bool Get(std::string_view content, Message* message) {
  ByteReader reader(content);
  message->channel_id = reader.Get<std::uint16_t>();
  message->sequence = reader.Get<std::uint32_t>();
  message->log_time_ns = reader.Get<std::int64_t>();
  message->publish_time_ns = reader.Get<std::int64_t>();
  message->data = reader.Rest();
  return reader.ok();
}

bool Get(std::string_view content, Attachment* attachment) {
  ByteReader reader(content);
  attachment->log_time_ns = reader.Get<std::int64_t>();
  attachment->create_time_ns = reader.Get<std::int64_t>();
  attachment->name = reader.Text();
  attachment->media_type = reader.Text();
  attachment->data = reader.Raw(reader.Get<std::uint64_t>());
  const std::size_t covered = content.size() - reader.left();
  const auto crc = reader.Get<std::uint32_t>();
  return reader.ok() && (crc == 0 || crc == Crc32(content.substr(0, covered)));
}

bool Get(std::string_view content, Metadata* metadata) {
  ByteReader reader(content);
  metadata->name = reader.Text();
  metadata->values = reader.Map();
  return reader.ok();
}

bool Get(std::string_view content, ChunkIndex* index) {
  ByteReader reader(content);
  index->start_time_ns = reader.Get<std::int64_t>();
  index->end_time_ns = reader.Get<std::int64_t>();
  index->offset = reader.Get<std::uint64_t>();
  index->length = reader.Get<std::uint64_t>();
  if (!GetNumbers(reader, &index->message_index_offsets)) return false;
  index->message_index_length = reader.Get<std::uint64_t>();
  index->compression = reader.Text();
  index->compressed_size = reader.Get<std::uint64_t>();
  index->uncompressed_size = reader.Get<std::uint64_t>();
  return reader.ok();
}

bool Get(std::string_view content, AttachmentIndex* index) {
  ByteReader reader(content);
  index->offset = reader.Get<std::uint64_t>();
  index->length = reader.Get<std::uint64_t>();
  index->log_time_ns = reader.Get<std::int64_t>();
  index->create_time_ns = reader.Get<std::int64_t>();
  index->data_size = reader.Get<std::uint64_t>();
  index->name = reader.Text();
  index->media_type = reader.Text();
  return reader.ok();
}

bool Get(std::string_view content, MetadataIndex* index) {
  ByteReader reader(content);
  index->offset = reader.Get<std::uint64_t>();
  index->length = reader.Get<std::uint64_t>();
  index->name = reader.Text();
  return reader.ok();
}

bool Get(std::string_view content, Statistics* statistics) {
  ByteReader reader(content);
  statistics->message_count = reader.Get<std::uint64_t>();
  statistics->schema_count = reader.Get<std::uint16_t>();
  statistics->channel_count = reader.Get<std::uint32_t>();
  statistics->attachment_count = reader.Get<std::uint32_t>();
  statistics->metadata_count = reader.Get<std::uint32_t>();
  statistics->chunk_count = reader.Get<std::uint32_t>();
  statistics->start_time_ns = reader.Get<std::int64_t>();
  statistics->end_time_ns = reader.Get<std::int64_t>();
  return GetNumbers(reader, &statistics->channel_message_counts);
}

bool Get(std::string_view content, Footer* footer) {
  ByteReader reader(content);
  footer->summary_start = reader.Get<std::uint64_t>();
  footer->summary_offset_start = reader.Get<std::uint64_t>();
  footer->summary_crc = reader.Get<std::uint32_t>();
  return reader.ok();
}

bool GetChunk(std::string_view content, ChunkHead* head, std::string_view* records) {
  ByteReader reader(content);
  head->start_time_ns = reader.Get<std::int64_t>();
  head->end_time_ns = reader.Get<std::int64_t>();
  head->uncompressed_size = reader.Get<std::uint64_t>();
  head->uncompressed_crc = reader.Get<std::uint32_t>();
  head->compression = reader.Text();
  head->compressed_size = reader.Get<std::uint64_t>();
  *records = reader.Raw(head->compressed_size);
  return reader.ok();
}

}  // namespace palpate::recording
