// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/operator_keys.hpp"

#include <gmock/gmock.h>

#include <string_view>
#include <vector>

namespace palpate::app {
namespace {

std::vector<OperatorKey> KeysOf(std::string_view bytes) {
  OperatorKeyDecoder decoder;
  std::vector<OperatorKey> keys;
  for (const char byte : bytes) {
    if (const auto key = decoder.Add(byte)) keys.push_back(*key);
  }
  return keys;
}

TEST(OperatorKeys, ArrowsAreThreeBytesAndLettersOne) {
  EXPECT_THAT(KeysOf("s\033[A\033OB\033[C\033[D+"),
              testing::ElementsAre(OperatorKeyOf('s'), OperatorKey::kUp, OperatorKey::kDown,
                                   OperatorKey::kRight, OperatorKey::kLeft, OperatorKeyOf('+')));
}

TEST(OperatorKeys, OtherSequencesOfATerminalAreNoKeys) {
  EXPECT_THAT(KeysOf("\033[1;5C\033[3~q"), testing::ElementsAre(OperatorKeyOf('q')));
}

}  // namespace
}  // namespace palpate::app
