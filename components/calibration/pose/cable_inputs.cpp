// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/cable_inputs.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/bounded_qp.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;

/// Smaller tolerances make rounding errors count as violations.
struct CableInputsTuning {
  double rounding_m = 1e-12;  ///< violation of a displacement limit
  double rounding_N = 1e-12;  ///< violation of a tension limit
  double slack_N = 1e-9;      ///< tension of a slack cable
  int max_rounds = 32;        ///< in which violated limits are added
};
constexpr CableInputsTuning kInputsTuning;

/// One half-space of Omega: row . lambda <= bound.
struct HalfSpace {
  enum class Kind { kLeastTension, kMostTension, kLeastDisplacement, kMostDisplacement };
  Kind kind;
  Index cable;
  Eigen::RowVectorXd row;
  double bound;
  double multiplier = 0.0;

  double Excess(const Eigen::VectorXd& lambda_a_N) const { return row * lambda_a_N - bound; }
};

using SpaceKind = HalfSpace::Kind;

HalfSpace MakeHalfSpace(const CableInputProblem& problem, SpaceKind kind, Index cable) {
  const CableLimits& limits = problem.limits[At(cable)];
  const Eigen::RowVectorXd unit = Eigen::RowVectorXd::Unit(problem.c.size(), cable);
  const double free_m = problem.delta_a_free_m[cable];
  switch (kind) {
    case SpaceKind::kLeastTension: return {kind, cable, -unit, -limits.least_tension_N};
    case SpaceKind::kMostTension: return {kind, cable, unit, limits.most_tension_N};
    case SpaceKind::kLeastDisplacement:
      return {kind, cable, -problem.W_aa.row(cable), free_m - limits.least_displacement_m};
    case SpaceKind::kMostDisplacement:
      return {kind, cable, problem.W_aa.row(cable), limits.most_displacement_m - free_m};
  }
  PALPATE_CHECK(false, cable);
  return {};
}

bool Binds(const HalfSpace& half_space, const Eigen::VectorXd& lambda_a_N, double slack_N) {
  if (!std::isfinite(half_space.bound)) return false;
  // The actuator of a slack cable may be anywhere below the upper limit.
  const bool slack = lambda_a_N[half_space.cable] <= slack_N;
  if (half_space.kind == SpaceKind::kMostDisplacement && slack) return false;
  const bool tension =
      half_space.kind == SpaceKind::kLeastTension || half_space.kind == SpaceKind::kMostTension;
  return half_space.Excess(lambda_a_N) >
         (tension ? kInputsTuning.rounding_N : kInputsTuning.rounding_m);
}

Status CheckLimits(const CableInputProblem& problem) {
  for (const CableLimits& one : problem.limits) {
    // Written so that NaN fails.
    if (!(one.least_tension_N <= one.most_tension_N) ||
        !(one.least_displacement_m <= one.most_displacement_m) || !(one.least_tension_N >= 0.0) ||
        !std::isfinite(one.least_tension_N)) {
      return {StatusCode::kInvalidInput, "limits of a cable that cross, or that let it push"};
    }
  }
  return Status::Ok();
}

/// With tension limits only.
Status SolveTensions(const CableInputProblem& problem, Eigen::VectorXd* lambda_a_N) {
  fem::BoundedQp qp{problem.Q, problem.c, problem.c, problem.c};
  for (Index i = 0; i < problem.c.size(); ++i) {
    qp.lower[i] = problem.limits[At(i)].least_tension_N;
    qp.upper[i] = problem.limits[At(i)].most_tension_N;
  }
  const fem::BoundedQpResult solution = fem::SolveBoundedQp(qp, fem::QpVector(*lambda_a_N));
  if (solution.status.ok()) *lambda_a_N = solution.x;
  return solution.status;
}

/// The minimum within some half-spaces, through its dual
///   min 1/2 mu' A Q^-1 A' mu + (b + A Q^-1 c)' mu over mu >= 0, lambda = -Q^-1 (c + A' mu).
Status SolveDual(const CableInputProblem& problem, const linalg::Cholesky& Q,
                 std::vector<HalfSpace>* half_spaces, Eigen::VectorXd* lambda_a_N) {
  const auto count = static_cast<Index>(half_spaces->size());
  if (count > fem::kMaxQpVariables) {
    return {StatusCode::kNotConverged, "too many limits of the cables are active at once"};
  }
  Eigen::MatrixXd A(count, problem.c.size());
  fem::QpVector b(count), start(count);
  for (Index i = 0; i < count; ++i) {
    const HalfSpace& one = (*half_spaces)[At(i)];
    A.row(i) = one.row;
    b[i] = one.bound;
    start[i] = one.multiplier;
  }
  const Eigen::MatrixXd responses = Q.Solve(Eigen::MatrixXd(A.transpose()));
  fem::BoundedQp dual;
  dual.H = A * responses;
  dual.c = b + A * Q.Solve(problem.c);
  dual.lower = fem::QpVector::Zero(count);
  dual.upper = fem::QpVector::Constant(count, std::numeric_limits<double>::infinity());
  const fem::BoundedQpResult solution = fem::SolveBoundedQp(dual, start);
  if (solution.status.code() == StatusCode::kUnobservable) {
    return {StatusCode::kTensionLimit, "no inputs satisfy all limits of the cables"};
  }
  if (!solution.status.ok()) return solution.status;
  for (Index i = 0; i < count; ++i) {
    (*half_spaces)[At(i)].multiplier = solution.x[i];
  }
  *lambda_a_N = -Q.Solve(problem.c) - responses * solution.x;
  return Status::Ok();
}

/// Adds the limits that `lambda_a_N` violates; true where there are any.
bool AddViolated(const CableInputProblem& problem, const Eigen::VectorXd& lambda_a_N,
                 double slack_N, std::vector<HalfSpace>* half_spaces) {
  bool added = false;
  for (Index cable = 0; cable < problem.c.size(); ++cable) {
    for (const SpaceKind kind : {SpaceKind::kLeastTension, SpaceKind::kMostTension,
                                 SpaceKind::kLeastDisplacement, SpaceKind::kMostDisplacement}) {
      const bool there =
          std::any_of(half_spaces->begin(), half_spaces->end(),
                      [&](const HalfSpace& one) { return one.kind == kind && one.cable == cable; });
      HalfSpace limit = MakeHalfSpace(problem, kind, cable);
      if (there || !Binds(limit, lambda_a_N, slack_N)) continue;
      half_spaces->push_back(std::move(limit));
      added = true;
    }
  }
  return added;
}

}  // namespace

Status SolveCableInputs(const CableInputProblem& problem, Eigen::VectorXd* lambda_a_N) {
  const Index cables = problem.c.size();
  PALPATE_CHECK(cables <= fem::kMaxQpVariables, cables);
  PALPATE_CHECK(lambda_a_N->size() == cables, lambda_a_N->size(), cables);
  PALPATE_CHECK(static_cast<Index>(problem.limits.size()) == cables, problem.limits.size(), cables);
  if (const Status status = CheckLimits(problem); !status.ok()) return status;
  Eigen::VectorXd solution_N = *lambda_a_N;
  if (Status status = SolveTensions(problem, &solution_N); !status.ok()) return status;

  std::vector<HalfSpace> half_spaces;
  const linalg::Cholesky Q(problem.Q);
  for (int round = 0; round < kInputsTuning.max_rounds; ++round) {
    if (!AddViolated(problem, solution_N, kInputsTuning.slack_N, &half_spaces)) {
      *lambda_a_N = solution_N;
      return Status::Ok();
    }
    if (!Q.ok()) {
      return {StatusCode::kUnobservable,
              "limits are active on cables that the markers do not determine"};
    }
    const Status status = SolveDual(problem, Q, &half_spaces, &solution_N);
    if (!status.ok()) return status;
  }
  return {StatusCode::kNotConverged, "the active limits of the cables were not found"};
}

}  // namespace palpate::calibration
