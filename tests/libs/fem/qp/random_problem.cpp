// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/qp/random_problem.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "libs/linalg/qr.hpp"

namespace palpate::fem::qp {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Numbers that do not depend on the standard library's distributions.
class Random {
 public:
  Random(Family family, std::uint32_t seed, int number) {
    std::seed_seq words{seed, static_cast<std::uint32_t>(family),
                        static_cast<std::uint32_t>(number)};
    engine_.seed(words);
    coarse_ = number / (2 * kMaxQpVariables) % 2 == 0;
  }

  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) * 0x1p-32;
  }
  int Below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  /// -2 to 2, coarse or fine.
  double Value() {
    const double value = Uniform(-2.0, 2.0);
    return coarse_ ? std::round(2.0 * value) / 2.0 : value;
  }

 private:
  std::mt19937 engine_;
  bool coarse_ = false;
};

/// A matrix R with H = R R'.
Eigen::MatrixXd Root(Family family, int n, Random* random) {
  const bool deficient = family == Family::kRankDeficient || family == Family::kSingularVertex;
  const int rank = deficient ? 1 + random->Below(n) : n;
  Eigen::MatrixXd root(n, rank);
  for (double& entry : root.reshaped()) entry = random->Value();
  for (int i = 1; i < n; ++i) {
    const int other = random->Below(i);
    if (family == Family::kDuplicateColumns && random->Below(3) == 0) {
      root.row(i) = (random->Below(2) == 0 ? 1.0 : -1.0) * root.row(other);
    } else if (family == Family::kNearDuplicates && random->Below(2) == 0) {
      root.row(i) = root.row(other) + std::pow(10.0, -1 - random->Below(5)) * root.row(i);
    }
  }
  if (family == Family::kEmptyColumns) {
    for (int i = 0; i < n; ++i) root.row(i) *= random->Below(3) == 0 ? 0.0 : 1.0;
  } else if (family == Family::kConditioned) {
    const Eigen::MatrixXd Q = linalg::DecomposeQr(root).Q;
    Eigen::VectorXd spread(n);
    for (double& entry : spread) entry = std::pow(10.0, random->Uniform(-4.0, 0.0));
    root = Q * spread.asDiagonal();
  }
  return root;
}

/// c, so that a point partly at bounds is optimal; bounds that it does not need open up.
void MakeVertex(Random* random, BoundedQp* qp) {
  QpVector optimum = 0.5 * (qp->lower + qp->upper);
  QpVector multiplier = QpVector::Zero(optimum.size());
  for (Eigen::Index i = 0; i < optimum.size(); ++i) {
    const int where = random->Below(5);
    const bool open = random->Below(2) == 0;
    if (where <= 1) {
      optimum[i] = qp->lower[i];
      if (where == 0) multiplier[i] = std::abs(random->Value());
      if (open) qp->upper[i] = kInfinity;
    } else if (where <= 3) {
      optimum[i] = qp->upper[i];
      if (where == 2) multiplier[i] = -std::abs(random->Value());
      if (open) qp->lower[i] = -kInfinity;
    } else if (open) {
      qp->lower[i] = -kInfinity;
      qp->upper[i] = kInfinity;
    }
  }
  qp->c = multiplier - qp->H * optimum;
}

BoundedQp MakePlain(Family family, int n, Random* random) {
  const Eigen::MatrixXd root = Root(family, n, random);
  BoundedQp qp{root * root.transpose(), QpVector(n), QpVector(n), QpVector(n)};
  for (int i = 0; i < n; ++i) {
    qp.c[i] = random->Value();
    const double a = random->Value();
    const double b = random->Value();
    qp.lower[i] = std::min(a, b);
    qp.upper[i] = std::max(a, b);
    if (family == Family::kEqualBounds && random->Below(3) == 0) qp.upper[i] = qp.lower[i];
  }
  if (family == Family::kVertex || family == Family::kSingularVertex) MakeVertex(random, &qp);
  return qp;
}

}  // namespace

std::string Name(Family family) {
  switch (family) {
    case Family::kFullRank: return "FullRank";
    case Family::kRankDeficient: return "RankDeficient";
    case Family::kDuplicateColumns: return "DuplicateColumns";
    case Family::kNearDuplicates: return "NearDuplicates";
    case Family::kEmptyColumns: return "EmptyColumns";
    case Family::kEqualBounds: return "EqualBounds";
    case Family::kConditioned: return "Conditioned";
    case Family::kVertex: return "Vertex";
    case Family::kSingularVertex: return "SingularVertex";
  }
  return "";
}

std::vector<Family> AllFamilies() {
  return {Family::kFullRank,       Family::kRankDeficient, Family::kDuplicateColumns,
          Family::kNearDuplicates, Family::kEmptyColumns,  Family::kEqualBounds,
          Family::kConditioned,    Family::kVertex,        Family::kSingularVertex};
}

RandomProblem MakeProblem(Family family, std::uint32_t seed, int number) {
  Random random(family, seed, number);
  const int n = 1 + number % kMaxQpVariables;
  RandomProblem problem;
  problem.plain = MakePlain(family, n, &random);
  problem.unit = QpVector::Ones(n);
  if (number / kMaxQpVariables % 2 == 1) {
    for (double& unit : problem.unit) unit = std::pow(10.0, random.Uniform(-8.0, 8.0));
  }
  const QpVector& unit = problem.unit;
  problem.scaled = {unit.asDiagonal() * problem.plain.H * unit.asDiagonal(),
                    unit.cwiseProduct(problem.plain.c), problem.plain.lower.cwiseQuotient(unit),
                    problem.plain.upper.cwiseQuotient(unit)};
  problem.start.resize(n);
  for (int i = 0; i < n; ++i) {
    const double lower = problem.scaled.lower[i];
    const bool on_bound = random.Below(3) == 0 && std::isfinite(lower);
    problem.start[i] = on_bound ? lower : random.Uniform(-3.0, 3.0) / unit[i];
  }
  return problem;
}

}  // namespace palpate::fem::qp
