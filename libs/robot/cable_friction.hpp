// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <vector>

namespace palpate::robot {

/// Coulomb friction of a cable in its eyelets (capstan, Euler-Eytelwein): where it turns by theta,
/// the tension changes by exp(-mu s theta) from the actuator on. While the cable slides there
/// towards the actuator s is 1, and the tension falls; while it slides out of the actuator s is -1,
/// and it rises. Where it sticks s is what balance asks for, in between.
struct CableFriction {
  double coefficient = 0.0;          ///< mu >= 0; 0: none
  std::vector<double> sliding = {};  ///< [eyelets] s in [-1, 1], or one for all of them; none: 1

  double Sliding(std::size_t eyelet) const {
    if (sliding.size() <= 1) return sliding.empty() ? 1.0 : sliding.front();
    return sliding[eyelet];
  }
  /// What it has of friction at an eyelet, mu s.
  double Signed(std::size_t eyelet) const { return coefficient * Sliding(eyelet); }
};

}  // namespace palpate::robot
