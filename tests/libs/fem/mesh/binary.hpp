// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

namespace palpate::fem::test {

/// `value` as bytes, in big or little endian order.
template <typename Value>
std::string Binary(Value value, bool big_endian) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  if (big_endian != (std::endian::native == std::endian::big)) {
    std::reverse(bytes.begin(), bytes.end());
  }
  return bytes;
}

}  // namespace palpate::fem::test
