// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/crc.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace palpate::recording {
namespace {

/// Bit by bit, after the definition.
std::uint32_t Definition(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc % 2 == 1 ? 0xEDB88320 : 0);
  }
  return ~crc;
}

std::string Random(std::size_t size, std::mt19937* random) {
  std::string bytes(size, '\0');
  for (char& c : bytes) c = static_cast<char>((*random)());
  return bytes;
}

TEST(Crc32, IsThatOfTheDefinitionForEveryLengthAndAlignment) {
  std::mt19937 random(1);
  const std::string bytes = Random(400, &random);
  EXPECT_EQ(Crc32("123456789"), 0xCBF43926);
  for (std::size_t size = 0; size < 300; ++size) {
    const std::string_view part = std::string_view(bytes).substr(size % 17, size);
    ASSERT_EQ(Crc32(part), Definition(part)) << size;
  }
}

TEST(Crc32, OfPartsIsThatOfTheWhole) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const std::string first = Random(random() % 300, &random);
    const std::string second = Random(random() % 300, &random);
    const std::uint32_t whole = Definition(first + second);
    EXPECT_EQ(Crc32(second, Crc32(first)), whole);
    EXPECT_EQ(CombinedCrc32(Crc32(first), Crc32(second), second.size()), whole);
  }
}

}  // namespace
}  // namespace palpate::recording
