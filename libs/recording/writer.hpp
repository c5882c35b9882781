// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libs/recording/compression.hpp"
#include "libs/recording/output_file.hpp"
#include "libs/recording/records.hpp"

namespace palpate::recording {

struct WriterOptions {
  Compression compression = Compression::kNone;
  int zstd_level = 1;
  /// Messages are collected up to this size; what was not yet in a chunk is lost with the process.
  std::size_t chunk_bytes = std::size_t{4} << 20;
  std::string profile = "ros2";
  std::string library;  ///< name and version of the program
};

/// Writes one MCAP file: messages in chunks with CRC and index, then statistics and an index of
/// all. Whatever write fails, the file then ends with its last whole chunk. Not thread-safe.
class Writer {
 public:
  /// Throws RunError where the output takes no bytes.
  Writer(std::unique_ptr<Output> output, const WriterOptions& options);
  /// Closes, if Close() has not been called; errors are then not told.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// The id of a schema or channel, which equal ones share. All throw RunError where the output
  /// does not take the bytes, or the file has 65535 of them.
  std::uint16_t AddSchema(const std::string& name, const std::string& encoding,
                          const std::string& data);
  /// `channel.id` is not used.
  std::uint16_t AddChannel(Channel channel);

  /// Its channel must have been added. Throws RunError where a chunk that is full cannot be
  /// written: its messages are lost, all chunks before it are in the file.
  void Write(const Message& message);
  void Write(const Attachment& attachment);
  void Write(const Metadata& metadata);

  /// Ends the open chunk, so that all messages so far outlast the process. Throws as Write().
  void Flush();
  /// Flush(), then index, statistics and footer. Throws RunError where they are not all in the
  /// file; it then ends with its last whole chunk and can be repaired.
  void Close();

  /// Bytes of the file and of the open chunk.
  std::uint64_t size() const { return position_ + chunk_.size(); }
  /// Of what is in the file; the open chunk is not.
  const Statistics& statistics() const { return statistics_; }

 private:
  using MessageIndex = std::vector<std::pair<std::int64_t, std::uint64_t>>;  ///< time, offset

  void Append(std::string_view bytes, std::optional<std::uint32_t> crc = {});
  template <typename Action>
  void AllOrNothing(const Action& action);
  /// `data`: of the last message of the chunk, where they are not in chunk_.
  void WriteChunk(std::string_view data = {});
  ChunkIndex IndexOf(const Compressor::Packed& packed, std::uint64_t head_size,
                     std::uint64_t uncompressed_size) const;
  void CountChunk();
  std::string Summary(std::uint64_t summary_start) const;

  std::unique_ptr<Output> output_;
  WriterOptions options_;
  Compressor compressor_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;  ///< of all that is in the file
  bool closed_ = false;
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::vector<ChunkIndex> chunk_indexes_;
  std::vector<AttachmentIndex> attachment_indexes_;
  std::vector<MetadataIndex> metadata_indexes_;
  Statistics statistics_;

  std::string chunk_;  ///< records of the open chunk
  std::map<std::uint16_t, MessageIndex> chunk_messages_;
  std::int64_t chunk_start_ns_ = 0;
  std::int64_t chunk_end_ns_ = 0;
};

}  // namespace palpate::recording
