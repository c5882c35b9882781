// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

namespace palpate::test_support {

/// Damages valid files as transfers and other programs do: bits, bytes, digits, cut ends, parts
/// that are repeated or missing.
class Mutations {
 public:
  explicit Mutations(unsigned seed) : random_(seed) {}

  std::string Of(std::string bytes) {
    const int count = 1 + Below(4);
    for (int k = 0; k < count && !bytes.empty(); ++k) Mutate(&bytes);
    return bytes;
  }

 private:
  int Below(std::size_t limit) {
    return static_cast<int>(std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_));
  }

  void Mutate(std::string* bytes) {
    const auto place = static_cast<std::size_t>(Below(bytes->size()));
    const auto length = std::min(static_cast<std::size_t>(1 + Below(40)), bytes->size() - place);
    char& byte = (*bytes)[place];
    switch (Below(7)) {
      case 0: byte = static_cast<char>(byte ^ (1 << Below(8))); break;
      case 1: byte = static_cast<char>(Below(256)); break;
      case 2: byte = "0123456789-.,;\t\n e"[Below(18)]; break;
      case 3: bytes->resize(place); break;
      case 4: bytes->erase(place, length); break;
      case 5: bytes->insert(place, bytes->substr(place, length)); break;
      default: bytes->insert(place, "99999999999"); break;
    }
  }

  std::mt19937 random_;
};

}  // namespace palpate::test_support
