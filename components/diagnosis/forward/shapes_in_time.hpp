// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace palpate::diagnosis {

/// Shapes of a body in a sample, by rising time; in single precision, for there are many.
struct ShapesInTime {
  std::vector<double> t_s;
  std::vector<Eigen::Matrix3Xf> nodes_m;  ///< [3 x nodes] robot frame

  bool empty() const { return t_s.empty(); }

  /// `of_shapes` [shapes]: something of each; straight between them, and beyond.
  double At(double now_s, const std::vector<double>& of_shapes) const {
    const auto [before, share] = Between(now_s);
    if (share == 0.0) return of_shapes[before];
    return (1.0 - share) * of_shapes[before] + share * of_shapes[before + 1];
  }
  template <typename Matrix>
  Matrix At(double now_s, const std::vector<Matrix>& of_shapes) const {
    using Scalar = typename Matrix::Scalar;
    const auto [before, share] = Between(now_s);
    if (share == 0.0) return of_shapes[before];
    return static_cast<Scalar>(1.0 - share) * of_shapes[before] +
           static_cast<Scalar>(share) * of_shapes[before + 1];
  }

 private:
  std::pair<std::size_t, double> Between(double now_s) const {
    if (t_s.size() < 2) return {0, 0.0};
    std::size_t next = 1;
    while (next + 1 < t_s.size() && t_s[next] < now_s) ++next;
    return {next - 1, (now_s - t_s[next - 1]) / (t_s[next] - t_s[next - 1])};
  }
};

}  // namespace palpate::diagnosis
