// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/text.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace palpate {
namespace {

std::vector<std::string> RandomWords(int count) {
  std::mt19937 generator(7);
  std::vector<std::string> words{""};
  for (int i = 1; i < count; ++i) {
    std::string word(generator() % 6, 'a');
    for (char& c : word) c = static_cast<char>('a' + generator() % 3);
    words.push_back(word);
  }
  return words;
}

TEST(Quoted, EscapesQuotesBackslashesAndControlCharacters) {
  EXPECT_EQ(Quoted("a b"), "\"a b\"");
  EXPECT_EQ(Quoted("a\"b\\c"), "\"a\\\"b\\\\c\"");
  EXPECT_EQ(Quoted("a\nb"), "\"a\\u000ab\"");
}

TEST(Excerpt, IsOneLineOfEightyCharactersAtMost) {
  EXPECT_EQ(Excerpt("short"), "short");
  EXPECT_EQ(Excerpt("two\nlines\t."), "two lines .");
  EXPECT_EQ(Excerpt(std::string(80, 'x')), std::string(80, 'x'));
  EXPECT_EQ(Excerpt(std::string(81, 'x')), std::string(77, 'x') + "...");
  EXPECT_EQ(Excerpt(std::string(76, 'x') + "\u00e9" + std::string(9, 'x')),
            std::string(76, 'x') + "...");
}

TEST(EditDistance, CountsSingleEdits) {
  EXPECT_EQ(EditDistance("cable", "cable"), 0);
  EXPECT_EQ(EditDistance("cable", "cables"), 1);
  EXPECT_EQ(EditDistance("cable", "able"), 1);
  EXPECT_EQ(EditDistance("cable", "cabin"), 2);
  EXPECT_EQ(EditDistance("cable", "calbe"), 1) << "a transposition is one edit";
  EXPECT_EQ(EditDistance("", "cable"), 5);
}

TEST(EditDistance, IsSymmetricAndZeroForEqualWordsOnly) {
  const auto words = RandomWords(60);
  for (const std::string& a : words) {
    for (const std::string& b : words) {
      EXPECT_EQ(EditDistance(a, b), EditDistance(b, a)) << a << ' ' << b;
      EXPECT_EQ(EditDistance(a, b) == 0, a == b) << a << ' ' << b;
    }
  }
}

TEST(EditDistance, LiesBetweenLengthDifferenceAndLongerLength) {
  const auto words = RandomWords(60);
  for (const std::string& a : words) {
    for (const std::string& b : words) {
      const int size_a = static_cast<int>(a.size());
      const int size_b = static_cast<int>(b.size());
      EXPECT_GE(EditDistance(a, b), std::abs(size_a - size_b)) << a << ' ' << b;
      EXPECT_LE(EditDistance(a, b), std::max(size_a, size_b)) << a << ' ' << b;
    }
  }
}

TEST(EditDistance, IsUnchangedByReversingBothWords) {
  for (const std::string& a : RandomWords(40)) {
    for (const std::string& b : RandomWords(40)) {
      const std::string reversed_a(a.rbegin(), a.rend());
      const std::string reversed_b(b.rbegin(), b.rend());
      EXPECT_EQ(EditDistance(a, b), EditDistance(reversed_a, reversed_b)) << a << ' ' << b;
    }
  }
}

TEST(DidYouMean, NamesTheNearestCandidate) {
  EXPECT_EQ(DidYouMean("calbes", {"mesh", "cables", "tables"}), " (did you mean 'cables'?)");
}

TEST(DidYouMean, StaysSilentWhereNothingIsNear) {
  EXPECT_EQ(DidYouMean("gravity", {"mesh", "cables"}), "");
  EXPECT_EQ(DidYouMean("gravity", {}), "");
}

TEST(ParseFinite, ReadsWholeNumbersOfTheCLocale) {
  double value = 0.0;
  EXPECT_TRUE(ParseFinite("-1.25e-3", &value));
  EXPECT_EQ(value, -1.25e-3);
  EXPECT_TRUE(ParseFinite("+4", &value));
  EXPECT_EQ(value, 4.0);
}

TEST(ParseFinite, RefusesAllElse) {
  double value = 0.0;
  for (const char* text : {"", " 1", "1 ", "1,5", "1e", "nan", "NaN", "inf", "-inf", "infinity",
                           "1e999", "+", "-", "+-5", "++5", "--5", "1_000", "five", "0x10"}) {
    EXPECT_FALSE(ParseFinite(text, &value)) << "'" << text << "'";
  }
}

TEST(FormatNumber, ReadsBackAsTheSameBits) {
  std::mt19937_64 generator(11);
  for (int i = 0; i < 20000; ++i) {
    const auto number = std::bit_cast<double>(static_cast<std::uint64_t>(generator()));
    if (!std::isfinite(number)) continue;
    double back = 0.0;
    ASSERT_TRUE(ParseFinite(FormatNumber(number), &back)) << FormatNumber(number);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(number));
  }
}

TEST(FormatNumber, WritesTheShortestText) {
  EXPECT_EQ(FormatNumber(0.1), "0.1");
  EXPECT_EQ(FormatNumber(-9.81), "-9.81");
  EXPECT_EQ(FormatNumber(0.0), "0");
  EXPECT_EQ(FormatNumber(std::numeric_limits<double>::max()), "1.7976931348623157e+308");
}

}  // namespace
}  // namespace palpate
