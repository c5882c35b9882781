// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate::fem::mesh_io {

/// How VTK packs the blocks of an array.
enum class Packing {
  kNone,
  kZlib,  ///< vtkZLibDataCompressor
  kLz4,   ///< vtkLZ4DataCompressor: LZ4 blocks without a frame
  kLzma,  ///< vtkLZMADataCompressor: .xz streams
};

/// Appends the `size` bytes that `packed` holds to `out`; false where it is damaged or holds more
/// or less. Never takes more memory than a sound block of these sizes.
[[nodiscard]] bool Unpack(Packing packing, std::string_view packed, size_t size, std::string* out);

}  // namespace palpate::fem::mesh_io
