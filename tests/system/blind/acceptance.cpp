// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/acceptance.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "libs/core/statistics.hpp"

namespace palpate::blind {

namespace {

class Verifier {
 public:
  explicit Verifier(double chance) : chance_(chance) {}

  void AtLeast(const char* what, const Share& share, double wanted) {
    if (BinomialAtMost(share.hits, share.count, wanted) < chance_) Miss(what, share, ">=", wanted);
  }
  void AtMost(const char* what, const Share& share, double wanted) {
    if (IsTooOften(share, wanted)) Miss(what, share, "<=", wanted);
  }
  /// Half of the values may lie beyond it.
  void MedianAtMost(const char* what, const std::vector<double>& values, double wanted) {
    const auto beyond = std::count_if(values.begin(), values.end(),
                                      [&](double value) { return !(value <= wanted); });
    const Share share{static_cast<int>(beyond), static_cast<int>(values.size())};
    if (IsTooOften(share, 0.5)) {
      missed_.push_back(fmt::format("{}: {:.3g} of {}, wanted <= {:.3g}", what, Median(values),
                                    values.size(), wanted));
    }
  }
  /// The forecasts of all bins together: so many are right as it says, give or take.
  void Calibrated(const std::vector<Forecast>& forecasts, double wanted) {
    Share right;
    double sum = 0.0;
    for (const Forecast& forecast : forecasts) {
      right.Add(forecast.right);
      sum += forecast.probability;
    }
    const double said = forecasts.empty() ? 0.0 : sum / right.count;
    if (IsTooOften(right, std::min(1.0, said + wanted)) ||
        BinomialAtMost(right.hits, right.count, std::max(0.0, said - wanted)) < chance_) {
      missed_.push_back(fmt::format("probabilities: {:.3g} on average, right {} of {}", said,
                                    right.hits, right.count));
    }
  }

  std::vector<std::string> missed() const { return missed_; }

 private:
  bool IsTooOften(const Share& share, double wanted) const {
    return BinomialAtMost(share.count - share.hits, share.count, 1.0 - wanted) < chance_;
  }
  void Miss(const char* what, const Share& share, const char* relation, double wanted) {
    missed_.push_back(fmt::format("{}: {} of {}, wanted {} {:.3g} %", what, share.hits, share.count,
                                  relation, 100.0 * wanted));
  }

  double chance_;
  std::vector<std::string> missed_;
};

std::vector<double> Negated(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

}  // namespace

std::vector<std::string> Missed(const Score& score, const Acceptance& acceptance) {
  const Acceptance& a = acceptance;
  Verifier verify(a.chance);
  verify.AtMost("cases that were not made", {score.not_made, score.cases}, a.not_made_at_most);
  verify.AtMost("cases without a verdict", score.without_verdict, a.without_verdict_at_most);
  verify.AtLeast("one cause, named first", score.top1, a.top1_at_least);
  verify.AtLeast("one cause, among the first three", score.top3, a.top3_at_least);
  verify.AtMost("healthy robots accused", score.false_accusations, a.false_accusations_at_most);
  verify.AtLeast("two causes, both named", score.both, a.both_at_least);
  verify.AtLeast("two causes, one named", score.one, a.one_at_least);
  verify.AtMost("two causes, a third named", score.third, a.third_at_most);
  verify.AtLeast("outside of the catalogue, flagged", score.flagged, a.flagged_at_least);
  verify.AtMost("flagged inside of the catalogue", score.false_flags, a.false_flags_at_most);
  verify.AtLeast("corrupted data refused", score.unfit, a.unfit_at_least);
  verify.AtMost("sound data refused", score.wrongly_unfit, a.wrongly_unfit_at_most);
  verify.AtLeast("parameters inside their intervals", score.covered, a.covered_at_least);
  verify.AtMost("parameters inside their intervals", score.covered, a.covered_at_most);
  verify.MedianAtMost("median parameter error", score.parameter_errors,
                      a.median_parameter_error_at_most);
  verify.MedianAtMost("minus the median held-out gain", Negated(score.heldout_gains),
                      -a.median_heldout_gain_at_least);
  verify.Calibrated(score.forecasts, a.calibration_error_at_most);
  return verify.missed();
}

double BinomialAtMost(int hits, int count, double probability) {
  if (hits >= count) return 1.0;
  if (probability <= 0.0) return 1.0;
  if (probability >= 1.0) return 0.0;
  double sum = 0.0;
  for (int k = 0; k <= hits; ++k) {
    const double ways =
        std::lgamma(count + 1.0) - std::lgamma(k + 1.0) - std::lgamma(count - k + 1.0);
    sum += std::exp(ways + k * std::log(probability) + (count - k) * std::log1p(-probability));
  }
  return std::min(1.0, sum);
}

}  // namespace palpate::blind
