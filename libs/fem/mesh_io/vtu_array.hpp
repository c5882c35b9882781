// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/large_pages.hpp"
#include "libs/fem/mesh_io/packing.hpp"

namespace tinyxml2 {
class XMLElement;
}

namespace palpate::fem::mesh_io {

/// How one .vtu file stores its numbers.
struct VtuStorage {
  std::string file;   ///< for messages
  bool swap = false;  ///< byte order of the file is not that of this machine
  Packing packing = Packing::kNone;
  bool wide_header = false;             ///< header_type UInt64 instead of UInt32
  bool appended_base64 = false;         ///< AppendedData is base64, else raw
  std::string_view appended;            ///< AppendedData after its underscore
  std::vector<std::string_view> texts;  ///< cut out of the XML (CutArrayTexts)
};

/// All numbers of a DataArray, which must be `count`. Throws InputError naming file, line and array
/// where they are more or less, not finite, not of a known type, or cannot be decoded.
LargeVector<double> ReadRealArray(const tinyxml2::XMLElement& array, const VtuStorage& storage,
                                  int64_t count);
/// The same for arrays of integers.
LargeVector<int64_t> ReadIntegerArray(const tinyxml2::XMLElement& array, const VtuStorage& storage,
                                      int64_t count);

/// Whether the array says that it holds integers of a known type.
bool IsIntegerArray(const tinyxml2::XMLElement& array);

/// Throws InputError "file:line: array 'Name': message".
[[noreturn]] void FailAtArray(const tinyxml2::XMLElement& array, const VtuStorage& storage,
                              const std::string& message);

}  // namespace palpate::fem::mesh_io
