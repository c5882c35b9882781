// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate::fem::mesh_io {

/// `bytes` as one zlib stream (RFC 1950).
std::string Deflate(std::string_view bytes);

/// Appends the `size` bytes that the zlib stream `packed` holds to `out`; false where it is damaged
/// or holds another number of bytes. Claims beyond what zlib can pack cost no memory.
[[nodiscard]] bool Inflate(std::string_view packed, size_t size, std::string* out);

}  // namespace palpate::fem::mesh_io
