// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros2msg/cdr_reader.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace palpate::recording {
namespace {

using namespace std::string_literals;

const Definitions kCounted = ParseRos2msg("t/Counted",
                                          "std_msgs/Header header\nstring[] names\nint8[3] flags\n"
                                          "uint64 counter\nfloat64 value\n"
                                          "================\nMSG: std_msgs/Header\n"
                                          "int32 sec\nstring frame_id\n");

/// sec 1, "ab", ["x"], flags 1 2 3, counter 7, value 0.5; the header says little or big endian.
const std::string kLittle =
    "\0\1\0\0"s
    "\1\0\0\0"
    "\3\0\0\0"
    "ab\0"s
    "\0"s
    "\1\0\0\0"s
    "\2\0\0\0"s
    "x\0"s
    "\1\2\3"s
    "\0\0\0\0\0\0\0"s
    "\7\0\0\0\0\0\0\0"s
    "\0\0\0\0\0\0\xE0\x3F"s;

TEST(CdrReader, FindsTheCounterBehindFieldsOfEveryLength) {
  EXPECT_EQ(UnsignedField(kLittle, kCounted.at("t/Counted"), "counter", kCounted), 7u);
}

TEST(CdrReader, ReadsTheOtherByteOrder) {
  const std::string big =
      "\0\0\0\0"s
      "\0\0\0\1"s
      "\0\0\0\3"s
      "ab\0"s
      "\0"s
      "\0\0\0\1"s
      "\0\0\0\2"s
      "x\0"s
      "\1\2\3"s
      "\0\0\0\0\0\0\0"s
      "\0\0\0\0\0\0\0\7"s;
  EXPECT_EQ(UnsignedField(big, kCounted.at("t/Counted"), "counter", kCounted), 7u);
}

TEST(CdrReader, ACutMessageHasNoCounter) {
  for (std::size_t size = 0; size + 8 < kLittle.size(); ++size) {
    EXPECT_EQ(UnsignedField(kLittle.substr(0, size), kCounted.at("t/Counted"), "counter", kCounted),
              std::nullopt)
        << size;
  }
}

TEST(CdrReader, ALengthBeyondTheMessageEndsAtOnce) {
  const Definitions nested = ParseRos2msg("t/A",
                                          "B[] all\nuint64 counter\n===\nMSG: t/B\nC c\n"
                                          "===\nMSG: t/C\nuint8 x\n");
  const std::string claims = "\0\1\0\0\xFF\xFF\xFF\xFF"s;
  EXPECT_EQ(UnsignedField(claims, nested.at("t/A"), "counter", nested), std::nullopt);
}

TEST(CdrReader, ADefinitionThatUsesItselfEnds) {
  const Definitions endless = ParseRos2msg("t/A", "A more\nuint64 counter\n");
  EXPECT_EQ(UnsignedField(std::string(100, '\0'), endless.at("t/A"), "counter", endless),
            std::nullopt);
}

TEST(CdrReader, NumbersHaveTheValueOfTheirType) {
  EXPECT_EQ(NumberOf(0xFF, "int8"), -1.0);
  EXPECT_EQ(NumberOf(0xFF, "uint8"), 255.0);
  EXPECT_EQ(NumberOf(0xFFFE, "int16"), -2.0);
  EXPECT_EQ(NumberOf(0xFFFFFFFF, "int32"), -1.0);
  EXPECT_EQ(NumberOf(0xFFFFFFFF, "uint32"), 4294967295.0);
  EXPECT_EQ(NumberOf(std::numeric_limits<std::uint64_t>::max(), "int64"), -1.0);
  EXPECT_EQ(NumberOf(0x3F000000, "float32"), 0.5);
  EXPECT_EQ(NumberOf(0x3FE0000000000000, "float64"), 0.5);
}

}  // namespace
}  // namespace palpate::recording
