// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libs/fem/mesh_io/vtu_array.hpp"

namespace palpate::fem::mesh_io {

/// The bytes of a DataArray of format "binary" or "appended", decoded and inflated: exactly
/// count * item_size. Throws InputError as ReadRealArray does.
///
/// As VTK stores them (vtkXMLWriter): [size in bytes][data], or, compressed, [number of blocks]
/// [block size][size of the last block, 0: full][packed size of each block][packed blocks].
class ArrayBytes {
 public:
  ArrayBytes(const tinyxml2::XMLElement& array, const VtuStorage& storage, uint64_t count,
             size_t item_size);
  ArrayBytes(const ArrayBytes&) = delete;
  ArrayBytes& operator=(const ArrayBytes&) = delete;

  std::string_view view() const { return view_; }

 private:
  std::string decoded_;    ///< empty where they stand in the file as they are
  std::string_view view_;  ///< of the file, or of `decoded_`
};

}  // namespace palpate::fem::mesh_io
