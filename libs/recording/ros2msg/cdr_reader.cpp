// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros2msg/cdr_reader.hpp"

#include <bit>
#include <cstring>

namespace palpate::recording {

namespace {

constexpr std::size_t kHeader = 4;
/// No message of ROS nests deeper; a definition that uses itself must end.
constexpr int kMaxDepth = 50;

}  // namespace

CdrReader::CdrReader(std::string_view cdr) {
  if (cdr.size() < kHeader || cdr[0] != 0) return;
  const int kind = cdr[1];
  // 0, 1: XCDR1 big and little endian; 6, 7: XCDR2, where 8-byte numbers are aligned to 4.
  ok_ = kind == 0 || kind == 1 || kind == 6 || kind == 7;
  swap_ = kind % 2 == 0;
  max_align_ = kind >= 6 ? 4 : 8;
  bytes_ = cdr.substr(kHeader);
}

void CdrReader::Align(std::uint32_t size) {
  const std::size_t align = std::min(size, max_align_);
  at_ = (at_ + align - 1) / align * align;
}

std::string_view CdrReader::Take(std::uint64_t size) {
  if (!ok_ || at_ > bytes_.size() || size > bytes_.size() - at_) {
    ok_ = false;
    return {};
  }
  const std::string_view taken = bytes_.substr(at_, size);
  at_ += size;
  return taken;
}

std::uint64_t CdrReader::Bits(std::uint32_t size) {
  Align(size);
  const std::string_view taken = Take(size);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const std::size_t place = swap_ ? taken.size() - 1 - i : i;
    bits |= std::uint64_t{static_cast<std::uint8_t>(taken[i])} << (8 * place);
  }
  return bits;
}

std::int64_t CdrReader::Stamp_ns() {
  const auto seconds = static_cast<std::int32_t>(Bits(4));
  return seconds * std::int64_t{1'000'000'000} + static_cast<std::int64_t>(Bits(4));
}

std::string_view CdrReader::String() {
  std::string_view text = Take(Length());
  if (text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

std::string_view CdrReader::Array(std::uint64_t count, std::uint32_t size) {
  if (count == 0) return {};
  Align(size);
  return Take(count * size);
}

void CdrReader::Skip(const Field& field, const Definitions& definitions) {
  std::uint64_t count = 1;
  if (field.repeat == Repeat::kFixed) count = field.count;
  if (field.repeat == Repeat::kSequence) count = Length();
  if (const std::uint32_t size = SizeOfPrimitive(field.type)) {
    Array(count, size);
    return;
  }
  // Every value has a byte at least: a damaged length must not ask for more.
  ok_ = ok_ && count <= bytes_.size();
  for (std::uint64_t i = 0; i < count && ok_; ++i) SkipOne(field.type, definitions);
}

void CdrReader::SkipOne(const std::string& type, const Definitions& definitions) {
  if (type == "string") {
    String();
    return;
  }
  const auto found = definitions.find(type);
  if (found == definitions.end() || depth_ == kMaxDepth) {
    ok_ = false;
    return;
  }
  ++depth_;
  for (const Field& field : found->second.fields) Skip(field, definitions);
  --depth_;
}

double NumberOf(std::uint64_t bits, std::string_view ros_type) {
  if (ros_type == "float64") return std::bit_cast<double>(bits);
  if (ros_type == "float32") return double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
  if (ros_type == "int8") return static_cast<std::int8_t>(bits);
  if (ros_type == "int16") return static_cast<std::int16_t>(bits);
  if (ros_type == "int32") return static_cast<std::int32_t>(bits);
  if (ros_type == "int64") return static_cast<double>(static_cast<std::int64_t>(bits));
  return static_cast<double>(bits);
}

std::optional<std::uint64_t> UnsignedField(std::string_view cdr, const MessageDefinition& root,
                                           const std::string& name,
                                           const Definitions& definitions) {
  CdrReader reader(cdr);
  for (const Field& field : root.fields) {
    if (field.name != name) {
      reader.Skip(field, definitions);
      continue;
    }
    const bool is_unsigned = field.type.starts_with("uint") && field.repeat == Repeat::kOne;
    if (!is_unsigned) return std::nullopt;
    const std::uint64_t value = reader.Bits(SizeOfPrimitive(field.type));
    return reader.ok() ? std::optional(value) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace palpate::recording
