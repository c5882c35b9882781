// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <cmath>

namespace palpate::robot {

/// The play operator: what follows `input` with a play of full width `play` >= 0, from `before`.
/// How fast the input goes does not matter. NaN, before: in the middle; NaN, input: NaN.
inline double Play(double before, double input, double play) {
  if (std::isnan(before) || std::isnan(input)) return input;
  return std::clamp(before, input - 0.5 * play, input + 0.5 * play);
}

}  // namespace palpate::robot
