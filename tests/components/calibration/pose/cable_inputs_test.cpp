// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/cable_inputs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace palpate::calibration {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Four cables that pull at each other, their unlimited minimum at `wanted_N`.
CableInputProblem Problem(const Eigen::Vector4d& wanted_N, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> value;
  const auto draw = [&] { return value(random); };
  const Eigen::MatrixXd W = Eigen::MatrixXd::NullaryExpr(12, 4, draw);
  const Eigen::MatrixXd G = Eigen::MatrixXd::NullaryExpr(4, 4, draw);
  CableInputProblem problem;
  problem.Q = W.transpose() * W;
  problem.c = -problem.Q * wanted_N;
  problem.W_aa = 1e-3 * (G * G.transpose() + 4.0 * Eigen::Matrix4d::Identity());
  problem.delta_a_free_m = 1e-3 * Eigen::VectorXd::NullaryExpr(4, draw);
  problem.limits.resize(4);
  return problem;
}

Eigen::VectorXd Displacements_m(const CableInputProblem& problem, const Eigen::VectorXd& x_N) {
  return problem.W_aa * x_N + problem.delta_a_free_m;
}

double Objective(const CableInputProblem& problem, const Eigen::VectorXd& x_N) {
  return 0.5 * x_N.dot(problem.Q * x_N) + problem.c.dot(x_N);
}

bool Keeps(const CableInputProblem& problem, const Eigen::VectorXd& x_N, double within) {
  const Eigen::VectorXd delta_m = Displacements_m(problem, x_N);
  for (Eigen::Index c = 0; c < 4; ++c) {
    const CableLimits& limits = problem.limits[static_cast<size_t>(c)];
    if (x_N[c] < limits.least_tension_N - within || x_N[c] > limits.most_tension_N + within ||
        delta_m[c] < limits.least_displacement_m - within ||
        delta_m[c] > limits.most_displacement_m + within) {
      return false;
    }
  }
  return true;
}

TEST(CableInputs, WithoutLimitsInTheWayTheMinimumIsFound) {
  const Eigen::Vector4d wanted_N(1.2, 1.0, 0.5, 2.0);
  Eigen::VectorXd found_N = Eigen::VectorXd::Zero(4);
  ASSERT_TRUE(SolveCableInputs(Problem(wanted_N, 1), &found_N).ok());
  EXPECT_LT((found_N - wanted_N).norm(), 1e-12);
}

TEST(CableInputs, NothingWithinTheLimitsIsBetter) {
  int bound = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    CableInputProblem problem = Problem({1.2, -0.5, 1.0, 2.0}, seed);
    const Eigen::VectorXd free_m = Displacements_m(problem, Eigen::Vector4d(1.2, 0.0, 1.0, 2.0));
    for (size_t c = 0; c < 4; ++c) {
      const auto i = static_cast<Eigen::Index>(c);
      problem.limits[c].most_tension_N = 1.9;
      // Cables 0 and 3 stay taut, so that their most displacement binds.
      if (c == 0 || c == 3) problem.limits[c].least_tension_N = 0.1;
      if (c == 0) problem.limits[c].most_displacement_m = free_m[i] - 1e-3;
      if (c == 2) problem.limits[c].least_displacement_m = free_m[i] - 0.5e-3;
    }
    Eigen::VectorXd found_N = Eigen::VectorXd::Zero(4);
    const Status status = SolveCableInputs(problem, &found_N);
    ASSERT_TRUE(status.ok()) << seed << ": " << status.message();
    EXPECT_TRUE(Keeps(problem, found_N, 1e-10)) << seed;
    const Eigen::VectorXd delta_m = Displacements_m(problem, found_N);
    bound += std::abs(delta_m[0] - problem.limits[0].most_displacement_m) < 1e-10 ? 1 : 0;
    bound += std::abs(delta_m[2] - problem.limits[2].least_displacement_m) < 1e-10 ? 1 : 0;

    const double best = Objective(problem, found_N);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> tension(0.0, 1.9);
    for (int k = 0; k < 2000; ++k) {
      const Eigen::VectorXd any_N =
          Eigen::VectorXd::NullaryExpr(4, [&] { return tension(random); });
      if (!Keeps(problem, any_N, 0.0)) continue;
      for (const double part : {1e-4, 1e-2, 1.0}) {
        // Omega is convex here: on the way to what keeps the limits they are kept.
        EXPECT_GE(Objective(problem, found_N + part * (any_N - found_N)), best - 1e-10) << seed;
      }
    }
  }
  EXPECT_GT(bound, 20);
}

TEST(CableInputs, TheMostDisplacementDoesNotBindASlackCable) {
  CableInputProblem problem = Problem({1.0, -1.0, 1.0, 1.0}, 3);
  problem.Q = Eigen::Matrix4d::Identity();
  problem.c = -Eigen::Vector4d(1.0, -1.0, 1.0, 1.0);
  problem.limits[1].most_displacement_m =
      Displacements_m(problem, Eigen::Vector4d(1.0, 0.0, 1.0, 1.0))[1] - 1e-3;
  Eigen::VectorXd found_N = Eigen::VectorXd::Zero(4);
  ASSERT_TRUE(SolveCableInputs(problem, &found_N).ok());
  EXPECT_LT((found_N - Eigen::Vector4d(1.0, 0.0, 1.0, 1.0)).norm(), 1e-12);
}

TEST(CableInputs, RefusesLimitsThatCrossOrThatNothingKeeps) {
  const auto code = [](const CableInputProblem& problem) {
    Eigen::VectorXd found_N = Eigen::VectorXd::Constant(4, 0.25);
    const Status status = SolveCableInputs(problem, &found_N);
    EXPECT_EQ(found_N, Eigen::VectorXd::Constant(4, 0.25));
    return status.code();
  };
  CableInputProblem problem = Problem(Eigen::Vector4d::Ones(), 4);
  problem.limits[2] = {.least_tension_N = 2.0, .most_tension_N = 1.0};
  EXPECT_EQ(code(problem), StatusCode::kInvalidInput);
  problem.limits[2] = {.least_tension_N = -1.0};
  EXPECT_EQ(code(problem), StatusCode::kInvalidInput);
  problem.limits[2] = {.least_displacement_m = std::nan("")};
  EXPECT_EQ(code(problem), StatusCode::kInvalidInput);
  for (CableLimits& one : problem.limits) one = {.most_tension_N = 1.0};
  problem.limits[2].least_displacement_m = 1.0;
  EXPECT_EQ(code(problem), StatusCode::kTensionLimit);
  problem = Problem(Eigen::Vector4d::Ones(), 4);
  problem.c[0] = kInfinity;
  EXPECT_EQ(code(problem), StatusCode::kInvalidInput);
}

}  // namespace
}  // namespace palpate::calibration
