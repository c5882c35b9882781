// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "tests/system/blind/score.hpp"

namespace palpate::blind {

/// Figures that a set of cases must reach: the one place of these numbers.
struct Acceptance {
  double top1_at_least = 0.95;
  double top3_at_least = 0.99;
  double false_accusations_at_most = 0.05;
  double both_at_least = 0.75;
  double one_at_least = 0.95;
  double third_at_most = 0.10;
  double flagged_at_least = 0.70;
  double false_flags_at_most = 0.10;
  double unfit_at_least = 1.0;
  double wrongly_unfit_at_most = 0.0;
  double without_verdict_at_most = 0.0;
  double not_made_at_most = 0.05;
  double covered_at_least = 0.88;
  double covered_at_most = 0.99;
  double median_parameter_error_at_most = 0.05;
  double median_heldout_gain_at_least = 0.90;
  double calibration_error_at_most = 0.05;
  /// A figure counts as missed where it comes out as it did, or worse, less often than this for
  /// somebody who just reaches it: few cases do not condemn anybody by chance.
  double chance = 1e-3;
};

/// One line for each figure that is missed beyond chance, with the figure.
std::vector<std::string> Missed(const Score& score, const Acceptance& acceptance = {});

/// P(at most `hits` of `count`) where each hits with this probability.
double BinomialAtMost(int hits, int count, double probability);

}  // namespace palpate::blind
