// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

namespace palpate::fem::mesh_io {

/// Nodes and cells are counted with int. A file that claims more costs no memory before it is
/// refused.
inline constexpr std::int64_t kMaxCount = std::numeric_limits<int>::max();
/// The largest name that a Gmsh file gives a node or a cell.
inline constexpr std::int64_t kMaxTag = std::numeric_limits<std::int64_t>::max();
/// What separates the words of a file that is text.
inline constexpr std::string_view kWhiteSpace = " \t\r\n\v\f";
constexpr bool IsWhiteSpace(char letter) {
  return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

}  // namespace palpate::fem::mesh_io
