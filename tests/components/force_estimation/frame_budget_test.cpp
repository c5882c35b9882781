// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const Eigen::Vector3d kHub(0.0, 0.0, 0.125);
const Eigen::Vector3d kTipForce_N(0.2, -0.1, -0.7);

/// four_leg with a force on its hub, by a clock that the test steps: each look takes `tick_s`.
class FrameBudget : public testing::Test {
 protected:
  FrameBudget() : model_(Build(QuickFourLegRobot())) {
    config_.frame_tolerance = 1e-9;
    config_.frame_budget_s = 0.5;
  }

  MarkerForceEstimator MakeEstimator() {
    return MarkerForceEstimator(*model_, config_, 0.0, [this] { return now_s_ += tick_s_; });
  }
  MarkerFrame FrameAt(double cable_m) {
    const std::vector<robot::ActuatorCommand> cables(4, {Kind::kDisplacement, cable_m});
    return FrameUnder(*model_, cables, {LoadAt(*model_, kHub, 0.008, kTipForce_N)});
  }

  std::unique_ptr<robot::RobotModel> model_;
  Config config_ = WithContacts({"hub: 0, 0, 0.125, 0.008"});
  double now_s_ = 0.0;
  double tick_s_ = 0.0;
};

TEST_F(FrameBudget, AFrameWithoutTimeIsNotReportedAsConverged) {
  MarkerForceEstimator estimator = MakeEstimator();
  ASSERT_TRUE(estimator.Update(FrameAt(0.002)).status.ok());
  const ModelState good = estimator.last_good();
  tick_s_ = 1.0;
  const MarkerFrame moved = FrameAt(0.004);
  const ForceEstimate& late = estimator.Update(moved);
  EXPECT_EQ(late.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(late.status.message(), "time used up");
  EXPECT_EQ(late.iterations, 1);
  EXPECT_GT(late.frame_error, config_.frame_tolerance);
  EXPECT_TRUE(late.contacts.empty());
  EXPECT_TRUE(late.x_m.array().isNaN().all());
  EXPECT_EQ(estimator.last_good().x_m, good.x_m);
  EXPECT_EQ(estimator.last_good().lambda_f_N, good.lambda_f_N);
}

TEST_F(FrameBudget, TheNextFramesGoOnFromThere) {
  MarkerForceEstimator estimator = MakeEstimator();
  ASSERT_TRUE(estimator.Update(FrameAt(0.002)).status.ok());
  tick_s_ = 1.0;
  const MarkerFrame moved = FrameAt(0.004);
  int late = 0;
  while (late < 6 && !estimator.Update(moved).status.ok()) ++late;
  EXPECT_GE(late, 1);
  EXPECT_LE(late, 4);
  const ForceEstimate& estimate = estimator.Update(moved);
  ASSERT_TRUE(estimate.status.ok());
  ASSERT_EQ(estimate.contacts.size(), 1U);
  EXPECT_EQ(estimate.contacts[0].name, "hub");
  EXPECT_LT((estimate.contacts[0].force_N - kTipForce_N).norm(), 1e-6);
}

TEST_F(FrameBudget, TheFirstFrameTakesTheTimeThatItNeeds) {
  MarkerForceEstimator estimator = MakeEstimator();
  tick_s_ = 1.0;
  EXPECT_TRUE(estimator.Update(FrameAt(0.002)).status.ok());
}

TEST_F(FrameBudget, NoBudgetIsNoLimit) {
  config_.frame_budget_s = 0.0;
  MarkerForceEstimator estimator = MakeEstimator();
  tick_s_ = 1e6;
  EXPECT_TRUE(estimator.Update(FrameAt(0.002)).status.ok());
  EXPECT_TRUE(estimator.Update(FrameAt(0.004)).status.ok());
}

TEST_F(FrameBudget, StepsAreABudgetToo) {
  config_.max_iterations = 1;
  config_.frame_tolerance = 1e-4;
  MarkerForceEstimator estimator = MakeEstimator();
  const ForceEstimate& estimate = estimator.Update(FrameAt(0.004));
  EXPECT_EQ(estimate.status.code(), StatusCode::kBudgetReached);
  EXPECT_EQ(estimate.status.message(), "steps used up");
  EXPECT_TRUE(estimate.contacts.empty());
}

TEST_F(FrameBudget, ALooseToleranceTakesFewerStepsAndIsKeptTo) {
  const MarkerFrame first = FrameAt(0.002);
  const MarkerFrame moved = FrameAt(0.003);
  MarkerForceEstimator tight = MakeEstimator();
  ASSERT_TRUE(tight.Update(first).status.ok());
  const int tight_steps = tight.Update(moved).iterations;
  config_.frame_tolerance = 1e-3;
  MarkerForceEstimator loose = MakeEstimator();
  ASSERT_TRUE(loose.Update(first).status.ok());
  const ForceEstimate& estimate = loose.Update(moved);
  ASSERT_TRUE(estimate.status.ok());
  EXPECT_LT(estimate.iterations, tight_steps);
  EXPECT_LE(estimate.frame_error, 1e-3);
  EXPECT_LT((estimate.contacts[0].force_N - kTipForce_N).norm(), 5e-3);
}

TEST_F(FrameBudget, AFrameThatCannotBeFittedLeavesTheLastGoodState) {
  MarkerForceEstimator estimator = MakeEstimator();
  const MarkerFrame good_frame = FrameAt(0.002);
  ASSERT_TRUE(estimator.Update(good_frame).status.ok());
  const ModelState good = estimator.last_good();
  MarkerFrame bad = good_frame;
  bad.cables[0] = {Kind::kTension, 25.0};  // max_tension_N: 20
  EXPECT_EQ(estimator.Update(bad).status.code(), StatusCode::kTensionLimit);
  EXPECT_NE(estimator.Update(bad).status.message().find("cable "), std::string::npos);
  EXPECT_EQ(estimator.last_good().x_m, good.x_m);
  const ForceEstimate& again = estimator.Update(good_frame);
  ASSERT_TRUE(again.status.ok());
  EXPECT_LT((again.contacts[0].force_N - kTipForce_N).norm(), 1e-6);
}

}  // namespace
}  // namespace palpate::force_estimation
