// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "libs/recording/input_file.hpp"
#include "libs/recording/records.hpp"

namespace palpate::recording {

/// A stretch of the file with messages: a chunk, or records that stand outside chunks.
struct Block {
  bool is_chunk = true;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< with prefix
  std::int64_t start_time_ns = 0;
  std::int64_t end_time_ns = 0;
  std::optional<std::set<std::uint16_t>> channels;  ///< that have messages in it; nullopt: unknown
};

/// What a file says about itself, or what was found in it.
struct Contents {
  FileHeader header;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<Block> blocks;  ///< in the order of the file
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;
  /// Whether it comes from the file's own index; else the whole file was read.
  bool indexed = false;
  std::vector<std::string> problems;  ///< what is cut or damaged, each with its place
};

/// The summary at the end of the file. nullopt where there is none, it is damaged, or it has no
/// index of the messages.
std::optional<Contents> ReadSummary(const InputFile& file);

/// Reads all of the file and keeps what is whole. Throws InputError where the file does not begin
/// as MCAP does.
Contents Scan(const InputFile& file);

/// Throws InputError where the file does not begin as MCAP does.
void CheckMagic(const InputFile& file);

/// Whether there is a file that begins as MCAP does.
bool IsMcap(const std::filesystem::path& file);

/// The records of a block, unpacked and checked by their CRC. False, with the cause, where they
/// are damaged.
[[nodiscard]] bool ReadBlock(const InputFile& file, const Block& block, std::string* records,
                             std::string* cause);

}  // namespace palpate::recording
