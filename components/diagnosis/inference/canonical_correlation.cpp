// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/canonical_correlation.hpp"

#include <algorithm>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"
#include "libs/linalg/svd.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::diagnosis {

namespace {

/// [n x rank] W with W' S W = I of a Gram matrix S, in the directions that are not rounding.
Eigen::MatrixXd Whitener(const Eigen::MatrixXd& S) {
  constexpr double kRounding = 1e-12;
  const linalg::SymmetricEigen eigen = linalg::DecomposeSymmetric(S);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < eigen.values.size(); ++k) {
    if (eigen.values[k] > kRounding * S.diagonal().maxCoeff()) kept.push_back(k);
  }
  return eigen.vectors(Eigen::all, kept) *
         eigen.values(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

/// Of effects E and F = J of the faults, with the weighted columns C of the others: what these
/// leave of E is M E, M = I - C A^-1 C', A = I + C' C. All products follow from H = J' J: E' M M F
/// = E' F - (C' E)' V - U' V, with U = A^-1 C' E and V = A^-1 C' F.
double CanonicalCorrelation(const HypothesisSet& hypotheses, const Information& data,
                            const Eigen::VectorXd& scale, int a, int b) {
  const GaussianPrior prior = hypotheses.PriorWith({}, scale);
  const std::vector<Eigen::Index> own = hypotheses.ParametersOf({a, b});
  std::vector<Eigen::Index> free;
  for (Eigen::Index p = 0; p < prior.sigma.size(); ++p) {
    const bool is_own = std::find(own.begin(), own.end(), p) != own.end();
    if (prior.sigma[p] > 0.0 && !is_own) free.push_back(p);
  }
  const Eigen::VectorXd sigma = prior.sigma(free);
  Eigen::MatrixXd A = sigma.asDiagonal() * data.H(free, free) * sigma.asDiagonal();
  A.diagonal().array() += 1.0;
  const Eigen::MatrixXd by_others = sigma.asDiagonal() * data.H(free, own);
  const Eigen::MatrixXd explained = linalg::Cholesky(A).Solve(by_others);
  const Eigen::MatrixXd left =
      data.H(own, own) - by_others.transpose() * explained - explained.transpose() * explained;
  const Eigen::Index of_a = hypotheses.count(a);
  const Eigen::Index of_b = hypotheses.count(b);
  const Eigen::MatrixXd whiten_a = Whitener(left.topLeftCorner(of_a, of_a));
  const Eigen::MatrixXd whiten_b = Whitener(left.bottomRightCorner(of_b, of_b));
  if (whiten_a.cols() == 0 || whiten_b.cols() == 0) return 0.0;
  const Eigen::MatrixXd correlation =
      whiten_a.transpose() * left.topRightCorner(of_a, of_b) * whiten_b;
  return std::min(1.0, linalg::SingularValues(correlation)[0]);
}

}  // namespace palpate::diagnosis
