// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "libs/fem/bounded_qp.hpp"
#include "tests/libs/fem/qp/ipopt.hpp"
#include "tests/libs/fem/qp/random_problem.hpp"

namespace palpate::fem::qp {
namespace {

constexpr std::uint32_t kSeed = 20260311;
constexpr int kProblems = 352;  // 22 of each size
/// Problems of a family that Ipopt itself may fail to solve.
constexpr int kMaxSkipped = kProblems / 20;

/// PALPATE_QP_PROBLEM=17 repeats problem 17 alone (of the families that --gtest_filter leaves).
int OnlyProblem() {
  const char* number = std::getenv("PALPATE_QP_PROBLEM");
  return number == nullptr ? -1 : std::stoi(number);
}

/// Sum of the magnitudes of the objective's terms: what rounding acts on.
double ObjectiveTerms(const BoundedQp& qp, const QpVector& x) {
  const QpVector size = x.cwiseAbs();
  return 0.5 * size.dot(qp.H.cwiseAbs() * size) + size.dot(qp.c.cwiseAbs());
}

/// Distance from x to where a step down the gradient, cut at the bounds, ends; over the terms of
/// the gradient. Zero at the minimum, and nowhere else.
double KktViolation(const BoundedQp& qp, const QpVector& x) {
  const QpVector gradient = qp.H * x + qp.c;
  const QpVector moved = (x - gradient).cwiseMax(qp.lower).cwiseMin(qp.upper);
  const QpVector terms = qp.H.cwiseAbs() * x.cwiseAbs() + qp.c.cwiseAbs();
  return (moved - x).cwiseAbs().maxCoeff() / (1.0 + terms.maxCoeff());
}

void CheckOptimal(const RandomProblem& problem, const BoundedQpResult& result) {
  ASSERT_TRUE(result.status.ok()) << ToString(result.status.code());
  EXPECT_TRUE((result.x.array() >= problem.scaled.lower.array()).all() &&
              (result.x.array() <= problem.scaled.upper.array()).all());
  EXPECT_LE(result.kkt_residual, 1e-9);
  EXPECT_LE(KktViolation(problem.plain, problem.unit.cwiseProduct(result.x)), 1e-9);
}

/// Ipopt stays inside the bounds, so that the minimum cannot be above its objective.
void CompareWithIpopt(const RandomProblem& problem, const QpVector& x, const QpVector& ipopt_x) {
  const double ours = Objective(problem.plain, problem.unit.cwiseProduct(x));
  const double ipopt = Objective(problem.plain, ipopt_x);
  const double terms = ObjectiveTerms(problem.plain, ipopt_x);
  EXPECT_LE(ours, ipopt + 1e-11 * terms);
  EXPECT_GE(ours, ipopt - 1e-6 * (1.0 + terms));
}

void CheckWarmStart(const RandomProblem& problem, const BoundedQpResult& cold) {
  const BoundedQpResult warm = SolveBoundedQp(problem.scaled, cold.x);
  ASSERT_TRUE(warm.status.ok());
  const double terms = ObjectiveTerms(problem.scaled, cold.x);
  EXPECT_NEAR(Objective(problem.scaled, warm.x), Objective(problem.scaled, cold.x),
              1e-20 + 1e-11 * terms);
}

class BoundedQpAgainstIpopt : public testing::TestWithParam<Family> {};

TEST_P(BoundedQpAgainstIpopt, FindsAMinimumAsLowOrLower) {
  Ipopt ipopt;
  const int only = OnlyProblem();
  int skipped = 0;
  int max_iterations = 0;
  for (int number = 0; number < kProblems; ++number) {
    if (only >= 0 && number != only) continue;
    SCOPED_TRACE("family " + Name(GetParam()) + ", seed " + std::to_string(kSeed) + ", problem " +
                 std::to_string(number) + " (PALPATE_QP_PROBLEM=" + std::to_string(number) + ")");
    const RandomProblem problem = MakeProblem(GetParam(), kSeed, number);
    const BoundedQpResult result = SolveBoundedQp(problem.scaled, problem.start);
    CheckOptimal(problem, result);
    CheckWarmStart(problem, result);
    if (HasFailure()) break;
    max_iterations = std::max(max_iterations, result.iterations);
    if (const std::optional<QpVector> ipopt_x = ipopt.Solve(problem.plain); ipopt_x) {
      CompareWithIpopt(problem, result.x, *ipopt_x);
    } else {
      ++skipped;
    }
  }
  std::cout << Name(GetParam()) << ", seed " << kSeed << ": Ipopt failed on " << skipped << " of "
            << kProblems << "; we needed at most " << max_iterations << " iterations\n";
  EXPECT_LE(skipped, kMaxSkipped);
}

INSTANTIATE_TEST_SUITE_P(Families, BoundedQpAgainstIpopt, testing::ValuesIn(AllFamilies()),
                         [](const auto& parameter) { return Name(parameter.param); });

}  // namespace
}  // namespace palpate::fem::qp
