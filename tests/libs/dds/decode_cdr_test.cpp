// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/decode_cdr.hpp"

#include <gmock/gmock.h>

#include <random>
#include <string>

#include "palpate_msgs/msg/ForceArray.hpp"
#include "std_msgs/msg/String.hpp"

namespace palpate::dds {
namespace {

/// std_msgs/String "abc".
const std::string kLittle(
    "\x00\x01\x00\x00\x04\x00\x00\x00"
    "abc\x00",
    12);
const std::string kBig(
    "\x00\x00\x00\x00\x00\x00\x00\x04"
    "abc\x00",
    12);

TEST(DecodeCdr, ReadsBothByteOrders) {
  for (const std::string& cdr : {kLittle, kBig}) {
    Message<idl::std_msgs::String> message;
    ASSERT_TRUE(DecodeCdr(cdr, &message).ok());
    EXPECT_EQ(Text(message->data), "abc");
  }
}

TEST(DecodeCdr, RefusesWhatIsNoMessage) {
  Message<idl::std_msgs::String> message;
  SetText(message->data, "before");
  std::string version_2 = kLittle;
  version_2[1] = 7;
  std::string too_long = kLittle;
  too_long[4] = 100;
  std::string no_end = kLittle;
  no_end.back() = 'd';
  for (const std::string& cdr : {std::string(), kLittle.substr(0, 3), kLittle.substr(0, 4),
                                 kLittle.substr(0, 9), version_2, too_long, no_end}) {
    const Status status = DecodeCdr(cdr, &message);
    EXPECT_EQ(status.code(), StatusCode::kInvalidInput) << testing::PrintToString(cdr);
    EXPECT_EQ(Text(message->data), "before");
  }
}

TEST(DecodeCdr, SurvivesAnyBytes) {
  std::mt19937 random(3);
  for (int round = 0; round < 2000; ++round) {
    std::string cdr(4 + random() % 300, '\0');
    for (char& c : cdr) c = static_cast<char>(random() & (round % 2 == 0 ? 0xFF : 0x07));
    cdr.replace(0, 4, std::string("\x00\x01\x00\x00", 4));
    Message<idl::palpate_msgs::ForceArray> message;
    const Status status = DecodeCdr(cdr, &message);
    EXPECT_TRUE(status.ok() || status.code() == StatusCode::kInvalidInput);
  }
}

}  // namespace
}  // namespace palpate::dds
