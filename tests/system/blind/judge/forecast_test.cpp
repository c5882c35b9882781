// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/forecast.hpp"

#include <gtest/gtest.h>

/// What probabilities are worth.
namespace palpate::blind {
namespace {

TEST(BlindForecast, ProbabilitiesAreHeldToTheShareThatIsRight) {
  std::vector<Forecast> forecasts;
  for (int i = 0; i < 100; ++i) forecasts.push_back({0.95, i < 95});
  EXPECT_NEAR(CalibrationError(forecasts), 0.0, 1e-12);
  for (int i = 0; i < 100; ++i) forecasts.push_back({0.55, i < 95});
  EXPECT_NEAR(CalibrationError(forecasts), 0.2, 1e-12);
}

TEST(BlindForecast, ErrsByChanceAsACoinDoes) {
  EXPECT_EQ(CalibrationErrorByChance({}), 0.0);
  EXPECT_NEAR(CalibrationErrorByChance({{0.7, true}}), 2.0 * 0.7 * 0.3, 1e-12);
  // Of 100 coins heads are 50 give or take, on average, 100 choose 50 / 2^100 * 50.
  EXPECT_NEAR(CalibrationErrorByChance(std::vector<Forecast>(100, {0.5, true})), 0.0397946, 1e-7);
}

TEST(BlindForecast, ErrsByChanceInEachBinByItself) {
  // Two that say 0.2 and 0.25, both, one, or none of which come out right; one more says 0.9.
  const double two = 0.2 * 0.25 * 1.55 + (0.2 * 0.75 + 0.8 * 0.25) * 0.55 + 0.8 * 0.75 * 0.45;
  const double one = 2.0 * 0.9 * 0.1;
  EXPECT_NEAR(CalibrationErrorByChance({{0.2, false}, {0.25, true}, {0.9, true}}),
              (two + one) / 3.0, 1e-12);
}

}  // namespace
}  // namespace palpate::blind
