// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/plot/axis_ticks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "libs/core/error.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::plot {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Ge;
using testing::Le;

TEST(AxisTicks, AreRoundInsideTheRangeAndEvenlyApart) {
  for (const AxisRange range : {AxisRange{0.0, 30.0},
                                {-0.3, 1.7},
                                {0.013, 0.0131},
                                {4e5, 9e6},
                                {0.01, 0.71},
                                {-3.0, -1.0}}) {
    for (const int count : {1, 2, 5, 9}) {
      const AxisTicks ticks = MakeTicks(range, count);
      ASSERT_GE(ticks.values.size(), 2U);
      EXPECT_LE(ticks.values.size(), 2U * std::max(count, 2) + 2U);
      const double slack = 1e-6 * (range.upper - range.lower);
      EXPECT_THAT(ticks.values,
                  Each(testing::AllOf(Ge(range.lower - slack), Le(range.upper + slack))));
      const double step = ticks.values[1] - ticks.values[0];
      const double leading = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
      EXPECT_THAT(leading,
                  testing::AnyOf(DoubleNear(1, 1e-5), DoubleNear(2, 1e-5), DoubleNear(5, 1e-5)));
      for (std::size_t i = 0; i < ticks.values.size(); ++i) {
        EXPECT_NEAR(std::strtod(ticks.labels[i].c_str(), nullptr), ticks.values[i], 1e-3 * step);
      }
    }
  }
}

TEST(AxisTicks, RefusesARangeThatIsNone) {
  EXPECT_THROW(MakeTicks({1.0, 1.0}, 5), RunError);
  EXPECT_THROW(MakeTicks({0.0, kNaN}, 5), RunError);
}

TEST(AxisTicks, RoundsARangeOutwardToWholeMarks) {
  const AxisRange range = RoundOutward({0.0, 1.23}, 5);
  EXPECT_DOUBLE_EQ(range.lower, 0.0);
  EXPECT_NEAR(range.upper, 1.4, 1e-12);
  EXPECT_LT(RoundOutward({2.0, 2.0}, 5).lower, 2.0);
  EXPECT_GT(RoundOutward({2.0, 2.0}, 5).upper, 2.0);
}

TEST(FixedText, HasNoSignedZeroAndNoLocale) {
  EXPECT_EQ(FixedText(-0.001, 2), "0.00");
  EXPECT_EQ(FixedText(-1.005e3, 1), "-1005.0");
}

}  // namespace
}  // namespace palpate::plot
