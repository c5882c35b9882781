// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/group_scale.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// What the data say of the grouped parameters alone, all others integrated out.
struct Marginal {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  Eigen::VectorXd sigma;  ///< in units of the group's scale
  std::vector<int> group_of;

  double LnEvidence(const Eigen::VectorXd& ln_scale) const {
    Eigen::VectorXd D = sigma;
    for (Eigen::Index k = 0; k < D.size(); ++k) D[k] *= std::exp(ln_scale[group_of[At(k)]]);
    Eigen::MatrixXd A = D.asDiagonal() * H * D.asDiagonal();
    A.diagonal().array() += 1.0;
    const linalg::Cholesky factor(A);
    const Eigen::VectorXd g = D.cwiseProduct(b);
    return 0.5 * g.dot(factor.Solve(g)) - 0.5 * factor.LnDeterminant();
  }
};

Marginal MarginalOf(const Information& data, const GaussianPrior& prior,
                    const std::vector<int>& group_of) {
  std::vector<Eigen::Index> grouped;
  std::vector<Eigen::Index> others;
  Eigen::VectorXd b = data.b;
  Marginal marginal;
  for (Eigen::Index p = 0; p < prior.sigma.size(); ++p) {
    if (prior.mean[p] != 0.0) b -= prior.mean[p] * data.H.col(p);
    if (!(prior.sigma[p] > 0.0)) continue;
    const int group = group_of[At(p)];
    (group < 0 ? others : grouped).push_back(p);
    if (group >= 0) marginal.group_of.push_back(group);
  }
  const Eigen::VectorXd sigma = prior.sigma(others);
  Eigen::MatrixXd A = sigma.asDiagonal() * data.H(others, others) * sigma.asDiagonal();
  A.diagonal().array() += 1.0;
  Eigen::MatrixXd both(others.size(), grouped.size() + 1);
  both << sigma.asDiagonal() * data.H(others, grouped), sigma.cwiseProduct(b(others));
  const Eigen::MatrixXd solved = linalg::Cholesky(A).Solve(both);
  const auto count = std::ssize(grouped);
  const Eigen::MatrixXd explained = both.leftCols(count).transpose() * solved;
  marginal.H = data.H(grouped, grouped) - explained.leftCols(count);
  marginal.b = b(grouped) - explained.col(count);
  marginal.sigma = prior.sigma(grouped);
  return marginal;
}

/// Climbs along one coordinate by steps that grow, then halve; to `last_step`.
void ClimbAlong(const Marginal& marginal, Eigen::Index group, const GroupScaleTuning& tuning,
                Eigen::VectorXd* ln_scale, double* value) {
  const double least = std::log(tuning.least);
  const double most = std::log(tuning.most);
  for (double step = tuning.first_step; step >= tuning.last_step; step *= 0.5) {
    for (const double way : {step, -step}) {
      bool better = true;
      while (better) {
        Eigen::VectorXd next = *ln_scale;
        next[group] = std::clamp(next[group] + way, least, most);
        if (next[group] == (*ln_scale)[group]) break;
        const double there = marginal.LnEvidence(next);
        better = there > *value;
        if (!better) break;
        *ln_scale = next;
        *value = there;
      }
    }
  }
}

}  // namespace

Eigen::VectorXd InferGroupScale(const Information& data, const GaussianPrior& prior,
                                const std::vector<int>& group_of, int groups,
                                const Eigen::VectorXd& start, const GroupScaleTuning& tuning) {
  Eigen::VectorXd ln_scale = Eigen::VectorXd::Constant(groups, std::log(tuning.start));
  if (start.size() == groups) ln_scale = start.array().log();
  const Marginal marginal = MarginalOf(data, prior, group_of);
  if (marginal.sigma.size() == 0) return ln_scale.array().exp();
  double value = marginal.LnEvidence(ln_scale);
  for (int round = 0; round < tuning.most_rounds; ++round) {
    const double before = value;
    for (Eigen::Index group = 0; group < groups; ++group) {
      ClimbAlong(marginal, group, tuning, &ln_scale, &value);
    }
    if (value - before < tuning.last_step) break;
  }
  return ln_scale.array().exp();
}

}  // namespace palpate::diagnosis
