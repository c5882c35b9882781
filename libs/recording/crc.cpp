// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/crc.hpp"

#include <libdeflate.h>
#include <zlib.h>

namespace palpate::recording {

std::uint32_t Crc32(std::string_view bytes, std::uint32_t before) {
  if (bytes.empty()) return before;  // without bytes, libdeflate begins anew
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

std::uint32_t CombinedCrc32(std::uint32_t first, std::uint32_t second, std::uint64_t second_size) {
  return static_cast<std::uint32_t>(
      crc32_combine(first, second, static_cast<z_off_t>(second_size)));
}

}  // namespace palpate::recording
