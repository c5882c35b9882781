// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/imitation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "components/diagnosis/inference/screening.hpp"

namespace palpate::diagnosis {

namespace {

/// Data about causes, where a healthy robot's tolerances are not known.
class BesideTolerances {
 public:
  BesideTolerances(const CauseBook& book, const Information& data)
      : book_(book), tolerance_(book.BeliefWith({}).sigma) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index p = 0; p < tolerance_.size(); ++p) {
      if (tolerance_[p] > 0.0) free.push_back(p);
    }
    const Eigen::VectorXd sigma = tolerance_(free);
    const Eigen::MatrixXd D_H = sigma.asDiagonal() * data.H(free, Eigen::all);
    Eigen::MatrixXd A = D_H(Eigen::all, free) * sigma.asDiagonal();
    A.diagonal().array() += 1.0;
    H_ = data.H - D_H.transpose() * A.llt().solve(D_H);
  }

  /// [own x own] of these parameters, their own tolerances left out.
  Eigen::MatrixXd About(const std::vector<Eigen::Index>& own) const {
    Eigen::MatrixXd H = H_(own, own);
    std::vector<Eigen::Index> tolerated;
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (tolerance_[own[k]] > 0.0) tolerated.push_back(static_cast<Eigen::Index>(k));
    }
    if (tolerated.empty()) return H;
    const Eigen::MatrixXd told = H(tolerated, Eigen::all);
    Eigen::MatrixXd left = -H(tolerated, tolerated);
    for (std::size_t k = 0; k < tolerated.size(); ++k) {
      const double tolerance = tolerance_[own[static_cast<std::size_t>(tolerated[k])]];
      left(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) +=
          1.0 / (tolerance * tolerance);
    }
    return H + told.transpose() * left.ldlt().solve(told);
  }

  /// Squares of noise that a fault of this cause would make, expected.
  double Size(int withheld) const {
    const std::vector<Eigen::Index> own = book_.ParametersOf({withheld});
    return About(own).diagonal().dot(FaultSquares(withheld));
  }

  /// Which share of that these others would explain.
  double ExplainedBy(const std::vector<int>& others, int withheld) const {
    std::vector<Eigen::Index> own = book_.ParametersOf({withheld});
    const Eigen::Index count = std::ssize(own);
    const std::vector<Eigen::Index> of_others = book_.ParametersOf(others);
    const Eigen::Index count_of_others = std::ssize(of_others);
    own.insert(own.end(), of_others.begin(), of_others.end());
    const Eigen::MatrixXd H = About(own);
    const Eigen::MatrixXd both = H.bottomLeftCorner(count_of_others, count);
    Eigen::MatrixXd of_other = H.bottomRightCorner(count_of_others, count_of_others);
    Eigen::Index first = 0;
    for (const int other : others) {
      of_other.diagonal().segment(first, book_.count(other)) += FaultSquares(other).cwiseInverse();
      first += book_.count(other);
    }
    const Eigen::VectorXd squares = FaultSquares(withheld);
    const Eigen::MatrixXd explained = both.transpose() * of_other.ldlt().solve(both);
    return explained.diagonal().dot(squares) /
           H.topLeftCorner(count, count).diagonal().dot(squares);
  }

 private:
  /// [parameters] of a fault, what is believed of their squares.
  Eigen::VectorXd FaultSquares(int cause) const {
    constexpr double kNone = 1e-12;  // of what is held where it is
    const Belief belief = book_.BeliefWith({cause});
    const auto sigma = belief.sigma.segment(book_.first(cause), book_.count(cause)).array();
    const auto mean = belief.mean.segment(book_.first(cause), book_.count(cause)).array();
    return (sigma.square() + mean.square()).max(kNone);
  }

  const CauseBook& book_;
  Eigen::VectorXd tolerance_;
  Eigen::MatrixXd H_;
};

struct Imitation {
  int by = -1;
  double explained = 0.0;  ///< together with those named before
};

/// The cause of another id that explains most of the withheld one; none: there is no other.
std::optional<Imitation> BestBeside(const CauseBook& book, const BesideTolerances& beside,
                                    const std::vector<int>& named, int withheld) {
  std::optional<Imitation> best;
  for (int other = 0; other < book.size(); ++other) {
    const bool is_named = std::find(named.begin(), named.end(), other) != named.end();
    const bool is_withheld = book.cause(other).name().id == book.cause(withheld).name().id;
    if (!book.CanBeFault(other) || is_named || is_withheld) continue;
    const double explained = std::min(1.0, beside.ExplainedBy(With(named, other), withheld));
    if (!best || explained > best->explained) best = Imitation{other, explained};
  }
  return best;
}

}  // namespace

std::vector<double> ExplainedByOthers(const CauseBook& book, const Information& data,
                                      std::size_t others) {
  constexpr double kWouldShow = 20.0;  // squares of noise
  const BesideTolerances beside(book, data);
  std::vector<double> most(static_cast<std::size_t>(book.size()), -1.0);
  for (int k = 0; k < book.size(); ++k) {
    if (!book.CanBeFault(k) || beside.Size(k) < kWouldShow) continue;
    double& explained = most[static_cast<std::size_t>(k)];
    explained = 0.0;
    std::vector<int> named;
    while (named.size() < others) {
      const std::optional<Imitation> next = BestBeside(book, beside, named, k);
      if (!next || next->explained <= explained) break;
      explained = next->explained;
      named.push_back(next->by);
    }
  }
  return most;
}

double ShareOfImitated(const CauseBook& book, const Information& data, std::size_t others,
                       double explained) {
  struct OfId {
    double imitated = 0.0;
    double all = 0.0;
  };
  const std::vector<double> most = ExplainedByOthers(book, data, others);
  std::map<std::string, OfId> of_id;
  for (int k = 0; k < book.size(); ++k) {
    const double by_others = most[static_cast<std::size_t>(k)];
    if (by_others < 0.0) continue;
    OfId& one = of_id[book.cause(k).name().id];
    one.all += 1.0;
    one.imitated += by_others >= explained ? 1.0 : 0.0;
  }
  double sum = 0.0;
  for (const auto& [id, one] : of_id) sum += one.imitated / one.all;
  return of_id.empty() ? 1.0 : sum / static_cast<double>(of_id.size());
}

double ExplainedOfMisfit(const Fit& healthy, const Fit& fit) {
  constexpr double kSeen = 2.0;  // sigma of chi-squared
  const auto rows = static_cast<double>(fit.model.y.size());
  const double explained = healthy.posterior.misfit - fit.posterior.misfit;
  const double left = std::max(kSeen * std::sqrt(2.0 * rows), fit.posterior.misfit - rows);
  return explained > 0.0 ? explained / (explained + left) : 0.0;
}

double ChanceOfImitation(const CauseBook& book, const Fit& healthy, const Fit& fit,
                         bool looks_like_noise) {
  constexpr double kOutside = 1.0 / 20.0;  // as likely as one cause of the catalogue
  constexpr double kFurther = 1.0 / 3.0;   // as likely as that there is none
  const std::size_t named = fit.faults.size();
  const double before =
      looks_like_noise ? kOutside / std::pow(kFurther, static_cast<double>(named) - 1.0) : 1.0;
  const double imitated =
      before * ShareOfImitated(book, healthy.model.All(), named, ExplainedOfMisfit(healthy, fit));
  return imitated / (1.0 + imitated);
}

}  // namespace palpate::diagnosis
