// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"
#include "tests/support/heap_counter.hpp"

namespace palpate::force_estimation {
namespace {

/// four_leg, its cables pulled up to 1 mm further in each frame, and a growing force on the hub.
std::vector<MarkerFrame> Motion(robot::RobotModel& model) {
  std::vector<MarkerFrame> frames;
  fem::StaticState state = model.RestState();
  std::mt19937 random(1);
  for (int i = 0; i < 12; ++i) {
    std::vector<robot::ActuatorCommand> cables;
    for (int c = 0; c < 4; ++c)
      cables.push_back({Kind::kDisplacement, 0.003 + 2.5e-4 * i * (c + 1)});
    const auto load = LoadAt(model, {0.0, 0.0, 0.125}, 0.008, {0.1, 0.02 * i, -0.5 - 0.01 * i});
    EXPECT_TRUE(model.Solve(cables, {load}, &state).status.ok());
    frames.push_back(FrameOf(model, state, cables));
    AddNoise(2e-6, random, &frames.back());
  }
  return frames;
}

void ExpectNoAllocation(const std::vector<std::string>& contacts) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer has malloc";
  const auto model = Build(QuickFourLegRobot());
  const std::vector<MarkerFrame> frames = Motion(*model);
  MarkerForceEstimator estimator(*model, WithContacts(contacts), 0.05);
  ASSERT_TRUE(estimator.Update(frames[0]).status.ok());
  for (size_t i = 1; i < frames.size(); ++i) {
    const size_t before = test_support::HeapRequestCount();
    const bool ok = estimator.Update(frames[i]).status.ok();
    const size_t after = test_support::HeapRequestCount();
    EXPECT_TRUE(ok) << i;
    EXPECT_EQ(after - before, 0U) << "frame " << i;
  }
}

TEST(ForceEstimationAllocation, CounterSeesMalloc) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer has malloc";
  const size_t before = test_support::HeapRequestCount();
  const auto vector = std::make_unique<std::vector<double>>(1000);
  EXPECT_EQ(test_support::HeapRequestCount() - before, 2U);
  EXPECT_EQ(vector->size(), 1000U);
}

TEST(ForceEstimationAllocation, FramesWithOneGivenContactTakeNoMemory) {
  ExpectNoAllocation({"hub: 0, 0, 0.125, 0.008"});
}

TEST(ForceEstimationAllocation, FramesWithTwoGivenContactsTakeNoMemory) {
  ExpectNoAllocation({"hub: 0, 0, 0.125, 0.008", "a_leg_with_a_long_name: 0, 0.0598, 0.0858"});
}

TEST(ForceEstimationAllocation, FramesWithoutTimeTakeNoMemory) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer has malloc";
  const auto model = Build(QuickFourLegRobot());
  const std::vector<MarkerFrame> frames = Motion(*model);
  Config config = WithContacts({"a_hub_with_a_long_name: 0, 0, 0.125, 0.008"});
  config.frame_budget_s = 0.5;
  static double tick_s = 0.0;
  MarkerForceEstimator estimator(*model, config, 0.05,
                                 [now_s = 0.0]() mutable { return now_s += tick_s; });
  ASSERT_TRUE(estimator.Update(frames[0]).status.ok());
  int late = 0;
  for (size_t i = 1; i < frames.size(); ++i) {
    tick_s = i % 2 == 0 ? 0.0 : 1.0;  // every other frame is stopped after its first step
    const size_t before = test_support::HeapRequestCount();
    late += estimator.Update(frames[i]).status.code() == StatusCode::kBudgetReached ? 1 : 0;
    EXPECT_EQ(test_support::HeapRequestCount() - before, 0U) << "frame " << i;
  }
  EXPECT_EQ(late, 6);
}

RowTargets TargetsOf(const MarkerFrame& frame) {
  RowTargets targets;
  targets.rows = static_cast<int>(3 * frame.markers.size());
  targets.value_m.resize(targets.rows);
  targets.weight = Eigen::VectorXd::Constant(targets.rows, 1e8);
  for (size_t m = 0; m < frame.markers.size(); ++m) {
    targets.value_m.segment<3>(static_cast<Eigen::Index>(3 * m)) = frame.markers[m].position_m;
  }
  return targets;
}

TEST(ForceEstimationAllocation, StepsWithAKeptFactorAndSecantsTakeNoMemory) {
  if (!test_support::HeapRequestsAreCounted()) GTEST_SKIP() << "a sanitizer has malloc";
  const auto model = Build(QuickFourLegRobot());
  const std::vector<MarkerFrame> frames = Motion(*model);
  std::vector<RowTargets> targets;
  for (const MarkerFrame& frame : frames) targets.push_back(TargetsOf(frame));
  Config config;
  config.frame_tolerance = 1e-7;
  ForceNewton fitter(*model, config);
  fitter.KeepFactor(true);
  fitter.SetSites({{.patch = model->Patch({0.0, 0.0, 0.125}, 0.008)}});
  fem::StaticState rest = model->RestState();
  ASSERT_TRUE(model->Solve(frames[0].cables, {}, &rest).status.ok());
  fitter.ForgetFactor();
  ModelState state{true, true, rest.x_m, rest.multipliers_N, Eigen::VectorXd::Zero(3)};
  // A fit of so few steps that it does not make room for secants by the way.
  fitter.SetTolerance(0.1);
  ASSERT_TRUE(fitter.Fit(targets[0], frames[0].cables, &state).status.ok());
  ASSERT_LE(fitter.fit().chord_steps, 1);
  fitter.SetTolerance(config.frame_tolerance);
  int secant_steps = 0;
  for (size_t i = 1; i < frames.size(); ++i) {
    const fem::TimeBudget budget = fitter.BudgetOfWork(1e6);
    const size_t before = test_support::HeapRequestCount();
    const ForceFit& fit = fitter.Fit(targets[i], frames[i].cables, &state, budget);
    const size_t after = test_support::HeapRequestCount();
    EXPECT_TRUE(fit.status.ok()) << i;
    EXPECT_EQ(after - before, 0U) << "frame " << i;
    secant_steps += std::max(0, fit.chord_steps - 1);
  }
  EXPECT_GT(secant_steps, 10);
}

}  // namespace
}  // namespace palpate::force_estimation
