// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace palpate::recording {

/// The first and last bytes of every MCAP file.
inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
/// Opcode and length in front of each record.
inline constexpr std::size_t kRecordPrefix = 9;
/// Footer with its prefix.
inline constexpr std::size_t kFooterSize = kRecordPrefix + 20;

/// Kinds of records (mcap.dev/spec).
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

struct FileHeader {
  std::string profile;  ///< "ros2"
  std::string library;  ///< the program that wrote the file
};

/// How messages of one type are to be read.
struct Schema {
  std::uint16_t id = 0;  ///< above 0
  std::string name;      ///< "sensor_msgs/msg/Image"
  std::string encoding;  ///< "ros2msg", "omgidl"
  std::string data;      ///< the definition and those of all types that it uses
};

/// The messages of one topic that have one schema.
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: no schema is known
  std::string topic;
  std::string message_encoding;                 ///< "cdr"
  std::map<std::string, std::string> metadata;  ///< "offered_qos_profiles", as rosbag2 has it
};

struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0;      ///< when it was recorded, since the epoch
  std::int64_t publish_time_ns = 0;  ///< when it was sent, since the epoch
  std::string_view data;             ///< CDR with its header of 4 bytes
};

/// A file inside the file.
struct Attachment {
  std::int64_t log_time_ns = 0;
  std::int64_t create_time_ns = 0;
  std::string name;
  std::string media_type;
  std::string data;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;
};

/// A chunk without its records.
struct ChunkHead {
  std::int64_t start_time_ns = 0;
  std::int64_t end_time_ns = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: none
  std::string compression;
  std::uint64_t compressed_size = 0;
};

/// Where a chunk is, and what it holds.
struct ChunkIndex {
  std::int64_t start_time_ns = 0;
  std::int64_t end_time_ns = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;                                      ///< of the record with its prefix
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;  ///< by channel
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< of the record with its prefix
  std::int64_t log_time_ns = 0;
  std::int64_t create_time_ns = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< of the record with its prefix
  std::string name;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::int64_t start_time_ns = 0;  ///< 0 without messages
  std::int64_t end_time_ns = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct Footer {
  std::uint64_t summary_start = 0;  ///< 0: no summary
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  ///< 0: none
};

/// Appends whole records, prefix included.
void PutRecord(Opcode opcode, std::string_view content, std::string* out);
void Put(const FileHeader& header, std::string* out);
void Put(const Schema& schema, std::string* out);
void Put(const Channel& channel, std::string* out);
void Put(const Message& message, std::string* out);
/// A message's record up to its data, which must follow.
void PutMessageHead(const Message& message, std::string* out);
void Put(const Attachment& attachment, std::string* out);
void Put(const Metadata& metadata, std::string* out);
void Put(const ChunkIndex& index, std::string* out);
void Put(const AttachmentIndex& index, std::string* out);
void Put(const MetadataIndex& index, std::string* out);
void Put(const Statistics& statistics, std::string* out);
/// A chunk's record up to its compressed records, which must follow.
void PutChunkHead(const ChunkHead& head, std::string* out);

/// Read the content of a record, without its prefix. False where it is too short.
[[nodiscard]] bool Get(std::string_view content, FileHeader* header);
[[nodiscard]] bool Get(std::string_view content, Schema* schema);
[[nodiscard]] bool Get(std::string_view content, Channel* channel);
/// The data stay where they are.
[[nodiscard]] bool Get(std::string_view content, Message* message);
/// False for a CRC that does not fit, too.
[[nodiscard]] bool Get(std::string_view content, Attachment* attachment);
[[nodiscard]] bool Get(std::string_view content, Metadata* metadata);
[[nodiscard]] bool Get(std::string_view content, ChunkIndex* index);
[[nodiscard]] bool Get(std::string_view content, AttachmentIndex* index);
[[nodiscard]] bool Get(std::string_view content, MetadataIndex* index);
[[nodiscard]] bool Get(std::string_view content, Statistics* statistics);
[[nodiscard]] bool Get(std::string_view content, Footer* footer);
/// `records`: the chunk's compressed records, which stay where they are.
[[nodiscard]] bool GetChunk(std::string_view content, ChunkHead* head, std::string_view* records);

}  // namespace palpate::recording
