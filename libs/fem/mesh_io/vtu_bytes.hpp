// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>

#include "libs/fem/mesh_io/vtu_array.hpp"

namespace tinyxml2 {
class XMLText;
}

namespace palpate::fem::mesh_io {

/// The bytes of a DataArray of format "binary" or "appended", decoded and inflated: exactly
/// count * item_size. Throws InputError as ReadRealArray does.
///
/// As VTK stores them (vtkXMLWriter): [size in bytes][data], or, compressed, [number of blocks]
/// [block size][size of the last block, 0: full][packed size of each block][packed blocks].
std::string ReadBinaryArray(const tinyxml2::XMLElement& array, const VtuStorage& storage,
                            uint64_t count, size_t item_size);

/// The text between the tags, which is the first that is not blank; nullptr where there is none.
const tinyxml2::XMLText* ArrayText(const tinyxml2::XMLElement& array);

/// The attribute Name, or the name of the element around an array that has none.
std::string ArrayName(const tinyxml2::XMLElement& array);

}  // namespace palpate::fem::mesh_io
