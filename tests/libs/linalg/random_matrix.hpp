// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <random>

namespace palpate::linalg {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Normal entries.
inline Eigen::MatrixXd RandomMatrix(Eigen::Index rows, Eigen::Index cols, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(engine); });
}

/// Symmetric positive definite of condition 1e3 or less.
inline Eigen::MatrixXd RandomSpd(Eigen::Index size, unsigned seed) {
  const Eigen::MatrixXd root = RandomMatrix(size, 2 * size, seed);
  const Eigen::MatrixXd A = root * root.transpose() / static_cast<double>(2 * size);
  return A + 0.01 * Eigen::MatrixXd::Identity(size, size);
}

/// Largest entry of Q' Q - I.
inline double OrthonormalError(const Eigen::MatrixXd& Q) {
  const Eigen::MatrixXd gram = Q.transpose() * Q;
  if (gram.size() == 0) return 0.0;
  return (gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff();
}

}  // namespace palpate::linalg
