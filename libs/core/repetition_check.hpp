// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string_view>

namespace palpate {

struct RepetitionTuning {
  /// Changes of direction that are looked at. More: noise is known later, and more surely.
  std::size_t turns = 8;
  /// Of them, those that show noise: white noise turns back in 2 of 3, a motion hardly ever.
  /// More: noise is known later; fewer: a motion passes for noise.
  std::size_t least_turns_back = 5;
};

/// Finds out that a sensor's data come again, bit for bit, under a new stamp. Noise makes that
/// impossible, but a sensor without noise (a simulated one) repeats itself whenever nothing moves.
/// So data count as repeated only after they have shown noise: a mean of them that goes up and down
/// from frame to frame. Must be of many numbers: few of them, rounded, may repeat by chance.
class RepetitionCheck {
 public:
  explicit RepetitionCheck(const RepetitionTuning& tuning = {}) : tuning_(tuning) {}

  /// Whether these data, with their mean, are a copy of those before.
  bool IsRepeated(std::string_view data, double mean);

  /// Another sensor follows.
  void Forget();

 private:
  void LearnNoise(double step);

  RepetitionTuning tuning_;
  bool has_last_ = false;
  std::uint64_t last_hash_ = 0;
  double last_mean_ = 0.0;
  double last_step_ = 0.0;
  std::deque<bool> turned_back_;  ///< the last ones
  bool is_noisy_ = false;
};

}  // namespace palpate
