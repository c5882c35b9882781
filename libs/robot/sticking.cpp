// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sticking.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::robot {

/// Gauss-Seidel's method on s = clamp(before - slide / presliding), of which the slide falls as s
/// grows.
Eigen::VectorXd StickOrSlide(const Eigen::VectorXd& before, const Eigen::VectorXd& freely_m,
                             const Eigen::MatrixXd& slide_m) {
  constexpr int kMostRounds = 100;
  constexpr double kLittle = 1e-6;
  Eigen::VectorXd s = before;
  for (int round = 0; round < kMostRounds; ++round) {
    double moved = 0.0;
    for (Eigen::Index e = 0; e < s.size(); ++e) {
      const double own_m = std::max(0.0, slide_m(e, e));
      const double others_m = slide_m.row(e).dot(s - before) - slide_m(e, e) * (s[e] - before[e]);
      const double next =
          std::clamp(before[e] - (freely_m[e] + others_m) / (kPresliding_m + own_m), -1.0, 1.0);
      moved = std::max(moved, std::abs(next - s[e]));
      s[e] = next;
    }
    if (moved < kLittle) break;
  }
  return s;
}

}  // namespace palpate::robot
