// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/large_pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>

namespace palpate {
namespace {

TEST(LargeVector, HoldsWhatAVectorHoldsAtEverySize) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000},
                                  std::size_t{524287}, std::size_t{524288}, std::size_t{3000000}}) {
    LargeVector<double> values(count);
    std::iota(values.begin(), values.end(), 1.0);
    LargeVector<double> copy = values;
    copy.push_back(0.5);
    EXPECT_TRUE(std::equal(values.begin(), values.end(), copy.begin())) << count;
    EXPECT_EQ(copy.back(), 0.5);
  }
}

TEST(LargeVector, BeginsALargePageWhereItFillsTwo) {
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  const LargeVector<double> values(2 * kLargePage / sizeof(double));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(values.data()) % kLargePage, 0u);
}

TEST(LargeVector, TakesAValueWhereOneIsGiven) {
  const LargeVector<int> values(100, 7);
  EXPECT_EQ(std::count(values.begin(), values.end(), 7), 100);
}

TEST(AdviseLargePages, LeavesWhatIsWritten) {
  std::string bytes(std::size_t{5} << 20, 'x');
  AdviseLargePages(bytes);
  AdviseLargePages(std::string());
  EXPECT_EQ(bytes.find_first_not_of('x'), std::string::npos);
}

}  // namespace
}  // namespace palpate
