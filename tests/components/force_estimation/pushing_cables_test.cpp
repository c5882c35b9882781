// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/fit/force_newton.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kPush_N = 0.02;

/// A fit that ends, within a coarse tolerance, where the first cable pushes: what noisy rows make
/// of a cable that is about to become slack.
Status FitWhereACablePushes(double most_push_N) {
  const auto model = Build(QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> cables(4, {Kind::kDisplacement, 0.002});
  const fem::StaticState balance = SolveTruth(*model, cables, {});
  Config config;
  config.frame_tolerance = 0.1;
  ForceNewton fitter(*model, config);
  fitter.KeepFactor(true);
  fitter.TolerateCablesThatPush(most_push_N);
  RowTargets targets;
  targets.rows = static_cast<int>(fitter.rows().size());
  targets.value_m.resize(targets.rows);
  targets.weight = Eigen::VectorXd::Constant(targets.rows, 1e8);
  for (int r = 0; r < targets.rows; ++r) {
    targets.value_m[r] = fitter.rows()[static_cast<size_t>(r)].Value(balance.x_m);
  }
  ModelState state{true, true, balance.x_m, balance.multipliers_N, Eigen::VectorXd()};
  EXPECT_TRUE(fitter.Fit(targets, cables, &state).status.ok());
  // The first cable at its present length, with no more than a push in it.
  std::vector<robot::ActuatorCommand> slack = cables;
  slack[0] = {Kind::kTension, 0.0};
  EXPECT_TRUE(fitter.Fit(targets, slack, &state).status.ok());
  state.lambda_a_N[0] = -kPush_N;
  slack[0] = {Kind::kTension, -kPush_N};
  return fitter.Fit(targets, slack, &state).status;
}

TEST(PushingCables, AreNoFit) {
  EXPECT_EQ(FitWhereACablePushes(0.0).code(), StatusCode::kNotConverged);
}

TEST(PushingCables, AreToleratedAsFarAsWasSaid) {
  EXPECT_TRUE(FitWhereACablePushes(1.5 * kPush_N).ok());
  EXPECT_EQ(FitWhereACablePushes(0.5 * kPush_N).code(), StatusCode::kNotConverged);
}

}  // namespace
}  // namespace palpate::force_estimation
