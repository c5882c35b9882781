// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/complementarity.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// The x with M x + q = 0 in the rows that are `above` zero, and zero in the others.
Eigen::VectorXd SolveAbove(const Eigen::MatrixXd& M, const Eigen::VectorXd& q,
                           const std::vector<Eigen::Index>& above) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(q.size());
  if (above.empty()) return x;
  const Eigen::MatrixXd of_these = M(above, above);
  const Eigen::VectorXd wanted = -q(above);
  x(above) = linalg::Cholesky(of_these).Solve(wanted);
  return x;
}

}  // namespace

Eigen::VectorXd SolveComplementarity(const Eigen::MatrixXd& M, const Eigen::VectorXd& q,
                                     const Eigen::VectorXd& start) {
  constexpr int kPatience = 5;  // exchanges of all at once that make nothing better
  const Eigen::Index count = q.size();
  const int most = static_cast<int>(20 * count) + 100;
  std::vector<bool> is_above(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) is_above[At(i)] = start[i] > 0.0;
  Eigen::VectorXd x;
  auto fewest_wrong = std::numeric_limits<std::size_t>::max();
  int patience = kPatience;
  for (int round = 0; round < most; ++round) {
    std::vector<Eigen::Index> above;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (is_above[At(i)]) above.push_back(i);
    }
    x = SolveAbove(M, q, above);
    const Eigen::VectorXd y = M * x + q;
    std::vector<std::size_t> wrong;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (is_above[k] ? x[i] < 0.0 : y[i] < 0.0) wrong.push_back(k);
    }
    if (wrong.empty()) break;
    patience = wrong.size() < fewest_wrong ? kPatience : patience - 1;
    fewest_wrong = std::min(fewest_wrong, wrong.size());
    if (patience < 0) wrong.erase(wrong.begin(), wrong.end() - 1);  // Murty's rule
    for (const std::size_t k : wrong) is_above[k] = !is_above[k];
  }
  return x.cwiseMax(0.0);
}

}  // namespace palpate::diagnosis
