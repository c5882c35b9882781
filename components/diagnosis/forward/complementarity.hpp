// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::diagnosis {

/// x >= 0, M x + q >= 0, x' (M x + q) = 0 for a symmetric positive definite M, beginning with those
/// x above zero that `start` has there: block principal pivoting (J. J. Judice and F. M. Pires, A
/// block principal pivoting algorithm for large-scale strictly monotone linear complementarity
/// problems, Computers & Operations Research 21, 1994), which ends after finitely many exchanges.
/// Where rounding keeps it from that, the last x, whose negative entries are cut off.
Eigen::VectorXd SolveComplementarity(const Eigen::MatrixXd& M, const Eigen::VectorXd& q,
                                     const Eigen::VectorXd& start);

}  // namespace palpate::diagnosis
