// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace palpate::gige_vision {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// Numbers in network order, as GVCP, GVSP and the registers have them. The caller has checked that
/// the bytes are there.
std::uint16_t Get16(ByteView bytes, std::size_t at);
std::uint32_t Get32(ByteView bytes, std::size_t at);
std::uint64_t Get64(ByteView bytes, std::size_t at);

void Put16(Bytes* bytes, std::uint16_t value);
void Put32(Bytes* bytes, std::uint32_t value);
void Put64(Bytes* bytes, std::uint64_t value);

Bytes Encode32(std::uint32_t value);
Bytes Encode64(std::uint64_t value);
Bytes EncodeDouble(double value);
/// Cut to `length` - 1 bytes and filled with zeros, so that a reader finds an end.
Bytes EncodeText(std::string_view text, std::size_t length);

double DecodeDouble(ByteView bytes);

}  // namespace palpate::gige_vision
