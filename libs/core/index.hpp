// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <concepts>
#include <cstddef>

/// Numbers of things, between int, what std::vector counts with and what Eigen counts with.
namespace palpate {

/// A number that is not negative as an index of std::vector and its kin: names[At(marker)].
template <std::integral Int>
constexpr std::size_t At(Int index) {
  return static_cast<std::size_t>(index);
}

/// A number as Eigen::Index: matrix.col(ToIndex(k)).
template <std::integral Int>
constexpr std::ptrdiff_t ToIndex(Int number) {
  return static_cast<std::ptrdiff_t>(number);
}

}  // namespace palpate
