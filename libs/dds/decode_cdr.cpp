// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/decode_cdr.hpp"

#include <dds/ddsi/ddsi_cdrstream.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "libs/dds/invalid_message.hpp"

namespace palpate::dds {

namespace {

constexpr std::size_t kHeaderBytes = 4;
constexpr std::uint32_t kXcdr1 = 1;

}  // namespace

Status DecodeCdr(std::string_view cdr, const dds_topic_descriptor_t& descriptor, void* sample) {
  const bool fits = cdr.size() >= kHeaderBytes && cdr.size() < std::numeric_limits<int>::max();
  if (!fits || cdr[0] != 0 || static_cast<unsigned char>(cdr[1]) > 1) {
    return Invalid("no CDR of version 1: " + std::to_string(cdr.size()) + " bytes");
  }
  const bool is_big_endian = cdr[1] == 0;
  // The check below swaps bytes in place; numbers are read at multiples of 8.
  std::vector<std::uint64_t> words((cdr.size() - kHeaderBytes) / sizeof(std::uint64_t) + 1);
  auto* data = reinterpret_cast<char*>(words.data());
  std::memcpy(data, cdr.data() + kHeaderBytes, cdr.size() - kHeaderBytes);
  const auto size = static_cast<std::uint32_t>(cdr.size() - kHeaderBytes);
  std::uint32_t checked = 0;
  if (dds_stream_normalize_data(data, &checked, size, is_big_endian, kXcdr1, descriptor.m_ops) ==
      nullptr) {
    return Invalid(std::to_string(cdr.size()) + " bytes that are no " + descriptor.m_typename);
  }
  dds_istream_t stream;
  dds_istream_init(&stream, size, data, kXcdr1);
  dds_stream_read(&stream, static_cast<char*>(sample), descriptor.m_ops);
  return Status::Ok();
}

}  // namespace palpate::dds
