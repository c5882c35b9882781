// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace palpate::blind {

namespace {

using Bins = std::array<std::vector<Forecast>, 10>;

Bins InBins(const std::vector<Forecast>& forecasts) {
  Bins bins;
  for (const Forecast& forecast : forecasts) {
    const auto bin =
        std::min(static_cast<std::size_t>(10.0 * forecast.probability), bins.size() - 1);
    bins[bin].push_back(forecast);
  }
  return bins;
}

double SaidRight(const std::vector<Forecast>& bin) {
  double sum = 0.0;
  for (const Forecast& forecast : bin) sum += forecast.probability;
  return sum;
}

double ErrorOf(const std::vector<Forecast>& bin) {
  const auto right = std::count_if(bin.begin(), bin.end(),
                                   [](const Forecast& forecast) { return forecast.right; });
  return std::abs(SaidRight(bin) - static_cast<double>(right));
}

/// Over how many come out right, which is Poisson's binomial.
double MeanError(const std::vector<Forecast>& bin) {
  std::vector<double> chance_of = {1.0};
  for (const Forecast& forecast : bin) {
    chance_of.push_back(0.0);
    for (std::size_t right = chance_of.size() - 1; right > 0; --right) {
      chance_of[right] += forecast.probability * (chance_of[right - 1] - chance_of[right]);
    }
    chance_of[0] *= 1.0 - forecast.probability;
  }
  double mean = 0.0;
  for (std::size_t right = 0; right < chance_of.size(); ++right) {
    mean += chance_of[right] * std::abs(SaidRight(bin) - static_cast<double>(right));
  }
  return mean;
}

template <typename ErrorOfBin>
double MeanOverBins(const std::vector<Forecast>& forecasts, ErrorOfBin error_of) {
  if (forecasts.empty()) return 0.0;
  double sum = 0.0;
  for (const std::vector<Forecast>& bin : InBins(forecasts)) sum += error_of(bin);
  return sum / static_cast<double>(forecasts.size());
}

}  // namespace

double CalibrationError(const std::vector<Forecast>& forecasts) {
  return MeanOverBins(forecasts, ErrorOf);
}

double CalibrationErrorByChance(const std::vector<Forecast>& forecasts) {
  return MeanOverBins(forecasts, MeanError);
}

}  // namespace palpate::blind
