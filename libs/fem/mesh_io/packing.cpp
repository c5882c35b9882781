// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/packing.hpp"

#include <lz4.h>
#include <lzma.h>

#include <cstdint>
#include <limits>

#include "libs/core/check.hpp"
#include "libs/fem/mesh_io/zlib_stream.hpp"

namespace palpate::fem::mesh_io {

namespace {

bool UnpackLz4(std::string_view packed, size_t size, std::string* out) {
  constexpr size_t kGreatestRatio = 255;  // a byte of length adds at most that
  constexpr size_t kGreatestBlock = std::numeric_limits<int>::max();
  if (packed.size() > kGreatestBlock || size > kGreatestBlock) return false;
  if (size / kGreatestRatio > packed.size()) return false;
  const size_t start = out->size();
  out->resize(start + size);
  const int unpacked = LZ4_decompress_safe(packed.data(), out->data() + start,
                                           static_cast<int>(packed.size()), static_cast<int>(size));
  return unpacked >= 0 && static_cast<size_t>(unpacked) == size;
}

bool UnpackLzma(std::string_view packed, size_t size, std::string* out) {
  constexpr size_t kGreatestRatio = 16384;         // twice that of a block of zeros
  std::uint64_t memory_limit = 128 * 1024 * 1024;  // the decoder's, for the largest preset
  if (size / kGreatestRatio > packed.size()) return false;
  const size_t start = out->size();
  out->resize(start + size);
  size_t read = 0, written = 0;
  const lzma_ret result = lzma_stream_buffer_decode(
      &memory_limit, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &read,
      packed.size(), reinterpret_cast<std::uint8_t*>(out->data() + start), &written, size);
  return result == LZMA_OK && written == size;
}

}  // namespace

bool Unpack(Packing packing, std::string_view packed, size_t size, std::string* out) {
  switch (packing) {
    case Packing::kZlib: return Inflate(packed, size, out);
    case Packing::kLz4: return UnpackLz4(packed, size, out);
    case Packing::kLzma: return UnpackLzma(packed, size, out);
    case Packing::kNone: break;
  }
  PALPATE_CHECK(false, "not packed");
  return false;
}

}  // namespace palpate::fem::mesh_io
