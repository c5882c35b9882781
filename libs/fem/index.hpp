// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>

namespace palpate::fem {

/// A node's, cell's or column's number as what std::vector counts with. Not negative.
inline std::size_t At(int index) { return static_cast<std::size_t>(index); }

}  // namespace palpate::fem
