// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/zlib_stream.hpp"

#include <zlib.h>

#include "libs/core/check.hpp"

namespace palpate::fem::mesh_io {

namespace {

const Bytef* AsBytes(std::string_view bytes) {
  return reinterpret_cast<const Bytef*>(bytes.data());
}

}  // namespace

std::string Deflate(std::string_view bytes) {
  uLongf packed_size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(packed_size, '\0');
  const int result =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, AsBytes(bytes),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  PALPATE_CHECK(result == Z_OK, result);
  packed.resize(packed_size);
  return packed;
}

bool Inflate(std::string_view packed, size_t size, std::string* out) {
  constexpr size_t kGreatestRatio = 1040;  // of deflate: 258 bytes in two bits, and some room
  if (size / kGreatestRatio > packed.size()) return false;
  const size_t start = out->size();
  out->resize(start + size + 1);  // one byte more, so that a stream that is too long is seen
  uLongf inflated_size = static_cast<uLongf>(size + 1);
  const int result = uncompress(reinterpret_cast<Bytef*>(out->data() + start), &inflated_size,
                                AsBytes(packed), static_cast<uLong>(packed.size()));
  out->resize(start + size);
  return result == Z_OK && inflated_size == size;
}

}  // namespace palpate::fem::mesh_io
