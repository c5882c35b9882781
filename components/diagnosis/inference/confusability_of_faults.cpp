// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/confusability_of_faults.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "components/diagnosis/inference/forward_selection.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

/// Prior odds of an unmodelled cause; docs/diagnosis.md says from which blind sets.
struct ConfusabilityTuning {
  double least_effect = 20.0;      ///< chi-squared of a fault that the data would show
  double scatter_sigmas = 2.0;     ///< of chi-squared, that count as unexplained
  double unmodelled = 1.0 / 20.0;  ///< prior odds of an unmodelled cause, one fault named
  double further = 1.0 / 3.0;      ///< prior odds of a further fault over none
};
constexpr ConfusabilityTuning kConfusabilityTuning;

/// Data about faults, where the tolerances are not known.
class BesideTolerances {
 public:
  BesideTolerances(const HypothesisSet& hypotheses, const Information& data)
      : hypotheses_(hypotheses),
        tolerance_(hypotheses.PriorWith({}, hypotheses.InferScale(data, {})).sigma) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index p = 0; p < tolerance_.size(); ++p) {
      if (tolerance_[p] > 0.0) free.push_back(p);
    }
    const Eigen::VectorXd sigma = tolerance_(free);
    const Eigen::MatrixXd D_H = sigma.asDiagonal() * data.H(free, Eigen::all);
    Eigen::MatrixXd A = D_H(Eigen::all, free) * sigma.asDiagonal();
    A.diagonal().array() += 1.0;
    H_ = data.H - D_H.transpose() * linalg::Cholesky(A).Solve(D_H);
  }

  /// [own x own] of these parameters, their own tolerances left out.
  Eigen::MatrixXd About(const std::vector<Eigen::Index>& own) const {
    Eigen::MatrixXd H = H_(own, own);
    std::vector<Eigen::Index> tolerated;
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (tolerance_[own[k]] > 0.0) tolerated.push_back(ToIndex(k));
    }
    if (tolerated.empty()) return H;
    const Eigen::MatrixXd cross = H(tolerated, Eigen::all);
    Eigen::MatrixXd left = -H(tolerated, tolerated);
    for (std::size_t k = 0; k < tolerated.size(); ++k) {
      const double tolerance = tolerance_[own[At(tolerated[k])]];
      left(ToIndex(k), ToIndex(k)) += 1.0 / (tolerance * tolerance);
    }
    return H + cross.transpose() * linalg::SolveSymmetric(left, cross);
  }

  /// Squares of noise that a fault of this fault would make, expected.
  double Size(int withheld) const {
    const std::vector<Eigen::Index> own = hypotheses_.ParametersOf({withheld});
    return About(own).diagonal().dot(FaultSquares(withheld));
  }

  /// Which share of that these others would explain.
  double ExplainedBy(const std::vector<int>& others, int withheld) const {
    std::vector<Eigen::Index> own = hypotheses_.ParametersOf({withheld});
    const Eigen::Index count = std::ssize(own);
    const std::vector<Eigen::Index> of_others = hypotheses_.ParametersOf(others);
    const Eigen::Index count_of_others = std::ssize(of_others);
    own.insert(own.end(), of_others.begin(), of_others.end());
    const Eigen::MatrixXd H = About(own);
    const Eigen::MatrixXd both = H.bottomLeftCorner(count_of_others, count);
    Eigen::MatrixXd of_other = H.bottomRightCorner(count_of_others, count_of_others);
    Eigen::Index first = 0;
    for (const int other : others) {
      of_other.diagonal().segment(first, hypotheses_.count(other)) +=
          FaultSquares(other).cwiseInverse();
      first += hypotheses_.count(other);
    }
    const Eigen::VectorXd squares = FaultSquares(withheld);
    const Eigen::MatrixXd explained = both.transpose() * linalg::SolveSymmetric(of_other, both);
    return explained.diagonal().dot(squares) /
           H.topLeftCorner(count, count).diagonal().dot(squares);
  }

 private:
  /// [parameters] of a fault, the prior of their squares.
  Eigen::VectorXd FaultSquares(int fault) const {
    constexpr double kNone = 1e-12;  // of what is held where it is
    const GaussianPrior prior = hypotheses_.PriorWith({fault});
    const auto sigma =
        prior.sigma.segment(hypotheses_.first(fault), hypotheses_.count(fault)).array();
    const auto mean =
        prior.mean.segment(hypotheses_.first(fault), hypotheses_.count(fault)).array();
    return (sigma.square() + mean.square()).max(kNone);
  }

  const HypothesisSet& hypotheses_;
  Eigen::VectorXd tolerance_;
  Eigen::MatrixXd H_;
};

struct ConfusabilityOfFaults {
  int by = -1;
  double explained = 0.0;  ///< together with those named before
};

/// The fault of another id that explains most of the withheld one; none: there is no other.
std::optional<ConfusabilityOfFaults> BestBeside(const HypothesisSet& hypotheses,
                                                const BesideTolerances& beside,
                                                const std::vector<int>& named, int withheld) {
  std::optional<ConfusabilityOfFaults> best;
  for (int other = 0; other < hypotheses.size(); ++other) {
    const bool is_named = std::find(named.begin(), named.end(), other) != named.end();
    const bool is_withheld =
        hypotheses.model(other).name().id == hypotheses.model(withheld).name().id;
    if (!hypotheses.CanBeFault(other) || is_named || is_withheld) continue;
    const double explained = std::min(1.0, beside.ExplainedBy(With(named, other), withheld));
    if (!best || explained > best->explained) best = ConfusabilityOfFaults{other, explained};
  }
  return best;
}

}  // namespace

std::vector<double> ExplainedByOthers(const HypothesisSet& hypotheses, const Information& data,
                                      std::size_t others) {
  const BesideTolerances beside(hypotheses, data);
  std::vector<double> most(static_cast<std::size_t>(hypotheses.size()), -1.0);
  for (int k = 0; k < hypotheses.size(); ++k) {
    if (!hypotheses.CanBeFault(k) || beside.Size(k) < kConfusabilityTuning.least_effect) continue;
    double& explained = most[At(k)];
    explained = 0.0;
    std::vector<int> named;
    while (named.size() < others) {
      const std::optional<ConfusabilityOfFaults> next = BestBeside(hypotheses, beside, named, k);
      if (!next || next->explained <= explained) break;
      explained = next->explained;
      named.push_back(next->by);
    }
  }
  return most;
}

double ShareOfConfusable(const HypothesisSet& hypotheses, const Information& data,
                         std::size_t others, double explained) {
  struct OfId {
    double confusable = 0.0;
    double all = 0.0;
  };
  const std::vector<double> most = ExplainedByOthers(hypotheses, data, others);
  std::map<std::string, OfId> of_id;
  for (int k = 0; k < hypotheses.size(); ++k) {
    const double by_others = most[At(k)];
    if (by_others < 0.0) continue;
    OfId& one = of_id[hypotheses.model(k).name().id];
    one.all += 1.0;
    one.confusable += by_others >= explained ? 1.0 : 0.0;
  }
  double sum = 0.0;
  for (const auto& [id, one] : of_id) sum += one.confusable / one.all;
  return of_id.empty() ? 1.0 : sum / static_cast<double>(of_id.size());
}

double ExplainedOfMisfit(const Fit& null_model, const Fit& fit) {
  const auto rows = static_cast<double>(fit.model.y.size());
  const double explained = null_model.posterior.misfit - fit.posterior.misfit;
  const double left = std::max(kConfusabilityTuning.scatter_sigmas * std::sqrt(2.0 * rows),
                               fit.posterior.misfit - rows);
  return explained > 0.0 ? explained / (explained + left) : 0.0;
}

double ProbabilityOfConfusion(const HypothesisSet& hypotheses, const Fit& null_model,
                              const Fit& fit, bool is_noise) {
  const std::size_t named = fit.faults.size();
  const double before =
      is_noise ? kConfusabilityTuning.unmodelled /
                     std::pow(kConfusabilityTuning.further, static_cast<double>(named) - 1.0)
               : 1.0;
  const double confusable = before * ShareOfConfusable(hypotheses, null_model.model.All(), named,
                                                       ExplainedOfMisfit(null_model, fit));
  return confusable / (1.0 + confusable);
}

}  // namespace palpate::diagnosis
