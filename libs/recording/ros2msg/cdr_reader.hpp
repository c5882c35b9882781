// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "libs/recording/ros2msg/message_definition.hpp"

namespace palpate::recording {

/// Reads CDR (XCDR1 or plain XCDR2, either byte order) piece by piece. Once the bytes do not
/// suffice, ok() is false for good and all that is read is 0 or empty.
class CdrReader {
 public:
  /// `cdr`: with its header of 4 bytes; must outlive this.
  explicit CdrReader(std::string_view cdr);

  bool ok() const { return ok_; }

  /// A number of 1, 2, 4 or 8 bytes, as it is in memory of this machine.
  std::uint64_t Bits(std::uint32_t size);
  std::string_view String();
  std::uint32_t Length() { return static_cast<std::uint32_t>(Bits(4)); }
  /// A builtin_interfaces/Time, the first field of a std_msgs/Header.
  std::int64_t Stamp_ns();
  /// `count` numbers of `size` bytes, in the byte order of the message.
  std::string_view Array(std::uint64_t count, std::uint32_t size);
  bool swaps_bytes() const { return swap_; }

  /// Passes over a field with all its values.
  void Skip(const Field& field, const Definitions& definitions);

 private:
  void SkipOne(const std::string& type, const Definitions& definitions);
  void Align(std::uint32_t size);
  std::string_view Take(std::uint64_t size);

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool ok_ = false;
  bool swap_ = false;
  std::uint32_t max_align_ = 8;
  int depth_ = 0;
};

/// A number of `size` bytes of type `ros_type`, as double; a large 64-bit one is rounded.
double NumberOf(std::uint64_t bits, std::string_view ros_type);

/// The value of the unsigned field `name` at the top of a message, for instance its counter;
/// nullopt where it has none.
std::optional<std::uint64_t> UnsignedField(std::string_view cdr, const MessageDefinition& root,
                                           const std::string& name, const Definitions& definitions);

}  // namespace palpate::recording
