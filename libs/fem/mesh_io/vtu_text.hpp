// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "libs/fem/mesh_io/vtu_array.hpp"

namespace palpate::fem::mesh_io {

/// `xml` with the plain texts of its DataArrays cut out into `texts`, so that the XML parser does
/// not copy millions of numbers. In their place stand a mark and their line ends, which keeps the
/// line numbers of messages. Texts with comments, entities or CDATA stay.
std::string CutArrayTexts(std::string_view xml, std::vector<std::string_view>* texts);

struct ArrayText {
  std::string_view text;
  int line = 0;  ///< of the first word
};

/// The text between the tags, which is the first that is not blank; empty where there is none.
ArrayText TextOfArray(const tinyxml2::XMLElement& array, const VtuStorage& storage);

/// The attribute Name, or the name of the element around an array that has none.
std::string ArrayName(const tinyxml2::XMLElement& array);

}  // namespace palpate::fem::mesh_io
