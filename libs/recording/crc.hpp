// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string_view>

namespace palpate::recording {

/// The CRC-32 of zlib and PNG, which MCAP uses, of bytes that follow those of `before`.
std::uint32_t Crc32(std::string_view bytes, std::uint32_t before = 0);

/// Of two runs of bytes, one after the other, from the CRC-32 of each.
std::uint32_t CombinedCrc32(std::uint32_t first, std::uint32_t second, std::uint64_t second_size);

}  // namespace palpate::recording
