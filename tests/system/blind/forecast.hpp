// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

namespace palpate::blind {

/// What the first cause of a verdict is said to be worth, and whether it is one of those hidden.
struct Forecast {
  double probability = 0.0;  ///< 0 to 1
  bool right = false;
};

/// Mean over ten bins of probability, weighted by how many fall in: |mean probability - share
/// right|. 0 where there are none.
double CalibrationError(const std::vector<Forecast>& forecasts);

/// What that is on average where probabilities are as they should be, by chance alone: each
/// forecast is right as often as it says, whatever the others are. The fewer, the more.
double CalibrationErrorByChance(const std::vector<Forecast>& forecasts);

}  // namespace palpate::blind
