// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/fit/force_newton.hpp"
#include "libs/robot/frame_tracker.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"
#include "tests/support/feature_point_targets.hpp"
#include "tests/support/random_loading.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {
namespace {

using test_support::FrameTally;
using test_support::RandomLoading;

/// Looks at the clock after which a frame is stopped: the loop looks a few times in each step, the
/// static solver once in each iteration.
constexpr double kLooks = 60.0;

RowTargets NoisyTargets(const robot::RobotModel& model, const fem::StaticState& truth,
                        std::mt19937& random) {
  constexpr double kTargetSigma_m = 1e-4;
  RowTargets targets = test_support::ExactTargets(model, truth.x_m, kTargetSigma_m);
  for (int row = 0; row < targets.rows; row += 3) {
    targets.value_m.segment<3>(row) += NormalNoise(kTargetSigma_m, random);
  }
  return targets;
}

bool IsFinite(const ModelState& state) {
  return state.x_m.allFinite() && state.lambda_a_N.allFinite() && state.lambda_f_N.allFinite();
}

/// Residual of the state over the internal forces, found without the fitter.
double ResidualOf(robot::RobotModel& model, const fem::InterpolationWeights& patch,
                  const ModelState& state) {
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(state.x_m.size());
  model.AddWeight(force_N);
  for (size_t k = 0; k < patch.nodes.size(); ++k) {
    force_N.segment<3>(3 * patch.nodes[k]) += patch.weights[k] * state.lambda_f_N.head<3>();
  }
  fem::Linearisation& linearisation = model.linearisation();
  EXPECT_TRUE(linearisation.UpdateResidual(state.x_m, state.lambda_a_N, force_N).ok());
  return linearisation.residual_N().norm() / linearisation.internal_force_norm_N();
}

/// Fits the frames of one loading, each from what came of the one before.
void FitLoading(robot::RobotModel& model, const RandomLoading& loading,
                const fem::StaticState& at_rest, ForceNewton* fitter, FrameTally* tally) {
  const fem::SurfacePatch patch = model.Patch(loading.point_m, loading.patch_radius_m);
  fitter->SetSites({{.patch = patch}});
  robot::FrameTracker truth(model, {.relative_tolerance = 1e-9});
  truth.Start(at_rest);
  ModelState state{.valid = true,
                   .balanced = false,
                   .x_m = at_rest.x_m,
                   .lambda_a_N = at_rest.multipliers_N,
                   .lambda_f_N = Eigen::VectorXd::Zero(3)};
  std::mt19937 random(1);
  Eigen::VectorXd force_N(at_rest.x_m.size());
  for (int k = 1; k <= loading.frames; ++k) {
    force_N.setZero();
    for (size_t i = 0; i < patch.weights.nodes.size(); ++i) {
      force_N.segment<3>(3 * patch.weights.nodes[i]) +=
          patch.weights.weights[i] * loading.force_N * k / loading.frames;
    }
    if (!truth.Follow(loading.Cables(k), force_N).converged()) continue;  // no such frame is seen
    double looks = 0.0;
    const fem::TimeBudget budget(kLooks, [&looks] { return looks += 1.0; });
    state.balanced = false;
    const ForceFit& fit =
        fitter->Fit(NoisyTargets(model, truth.state(), random), loading.Cables(k), &state, budget);
    ASSERT_TRUE(IsFinite(state)) << "frame " << k;
    if (fit.status.ok()) {
      ASSERT_LE(ResidualOf(model, patch.weights, state), 1e-7) << "frame " << k;
      ASSERT_EQ(fitter->last_good().x_m, state.x_m);
    }
    if (fitter->last_good().valid) {
      ASSERT_TRUE(IsFinite(fitter->last_good()));
      ASSERT_LE(ResidualOf(model, patch.weights, fitter->last_good()), 1e-7) << "frame " << k;
    }
    const bool budget_reached = fit.status.code() == StatusCode::kBudgetReached;
    ++(fit.status.ok() ? tally->converged : budget_reached ? tally->budget : tally->diverged);
    tally->exact_steps += fit.iterations;
    tally->most_exact_steps = std::max(tally->most_exact_steps, fit.iterations);
  }
}

void FitLoadings(const std::string& name, const robot::RobotDescription& robot, int by_default) {
  robot::RobotModel model(test_support::WithFeaturePointsAsMarkers(robot::BuildRobotBody(robot)));
  fem::StaticState at_rest = model.RestState();
  const std::vector<robot::ActuatorCommand> slack(static_cast<size_t>(model.ActuatorCount()));
  ASSERT_TRUE(model.Solve(slack, {}, &at_rest).status.ok());
  Config config;
  config.frame_tolerance = 1e-8;
  ForceNewton fitter(model, config);
  const test_support::LoadingRange range = test_support::LoadingsToRun(by_default);
  FrameTally tally;
  for (int index = range.first; index < range.end; ++index) {
    SCOPED_TRACE("PALPATE_LOADING=" + std::to_string(index));
    FitLoading(model, test_support::MakeRandomLoading(model, index), at_rest, &fitter, &tally);
    if (testing::Test::HasFatalFailure()) return;
  }
  tally.Print(name, range.end - range.first);
  EXPECT_GE(tally.converged, 0.8 * tally.frames());
}

TEST(FitOfRandomLoadings, ConvergesOnTheDiamondOrSaysThatItDidNot) {
  const auto robot = test_support::DiamondRobot();
  if (!robot) GTEST_SKIP() << "the paper's mesh is not there (PALPATE_DATA_DIR)";
  FitLoadings("diamond", *robot, 25);
}

TEST(FitOfRandomLoadings, ConvergesOnOurRobotOrSaysThatItDidNot) {
  FitLoadings("four_leg", test_support::LockingFourLegRobot(), 25);
}

}  // namespace
}  // namespace palpate::force_estimation
