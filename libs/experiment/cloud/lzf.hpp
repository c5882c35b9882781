// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate::experiment {

/// Unpacks LZF (M. Lehmann's LibLZF, the packing of PCD's binary_compressed): literal runs and
/// copies of what was unpacked before. False where the bytes are no such stream, or do not give
/// exactly `size` bytes; never reads or writes outside.
bool UnpackLzf(std::string_view packed, std::size_t size, std::string* unpacked);

}  // namespace palpate::experiment
