// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/force_estimation/fit/force_newton.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"
#include "tests/support/feature_point_targets.hpp"
#include "tests/support/random_loading.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {
namespace {

/// A robot seen at 51 points, with two contacts whose forces change, while its first cable goes to
/// 20 mm and back by 1 mm a frame.
class Sweep {
 public:
  explicit Sweep(const robot::RobotDescription& robot)
      : model_(test_support::WithFeaturePointsAsMarkers(robot::BuildRobotBody(robot))) {
    const auto& points = model_.body().feature_points;
    const auto by_height = [](const fem::BodyPoint& a, const fem::BodyPoint& b) {
      return a.rest_m.z() < b.rest_m.z();
    };
    const auto top = std::max_element(points.begin(), points.end(), by_height);
    const auto side =
        std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
          const double wanted_m = 0.06;
          return std::abs((a.rest_m - top->rest_m).norm() - wanted_m) <
                 std::abs((b.rest_m - top->rest_m).norm() - wanted_m);
        });
    sites_ = {{.patch = model_.Patch(top->rest_m, 0.005)},
              {.patch = model_.Patch(side->rest_m, 0.005)}};
    truth_ = model_.RestState();
    Solve(0);
  }

  static constexpr int kFrames = 40;

  /// Moves the truth to the frame.
  void Solve(int frame) {
    std::vector<robot::DeadLoad> loads;
    for (size_t s = 0; s < sites_.size(); ++s) {
      loads.push_back(
          {sites_[s].patch.weights, Forces_N(frame).segment<3>(static_cast<Eigen::Index>(3 * s))});
    }
    const fem::StaticResult result = model_.Solve(Cables(frame), loads, &truth_);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
  }
  std::vector<robot::ActuatorCommand> Cables(int frame) const {
    std::vector<robot::ActuatorCommand> cables(static_cast<size_t>(model_.ActuatorCount()),
                                               {Kind::kDisplacement, 0.0});
    cables[0].value = 1e-3 * (frame <= 20 ? frame : 40 - frame);
    return cables;
  }
  static Eigen::VectorXd Forces_N(int frame) {
    Eigen::VectorXd forces_N(6);
    forces_N << 0.2 * std::sin(0.3 * frame), 0.1, -0.3 * std::cos(0.2 * frame), 0.1,
        0.15 * std::cos(0.25 * frame), -0.1 * std::sin(0.2 * frame);
    return forces_N;
  }
  RowTargets Targets() const { return test_support::ExactTargets(model_, truth_.x_m, 1e-4); }
  ModelState Start() const {
    return {.valid = true,
            .balanced = true,
            .x_m = truth_.x_m,
            .lambda_a_N = truth_.multipliers_N,
            .lambda_f_N = Forces_N(0)};
  }
  double MedianError_m(const ModelState& state) const {
    std::vector<double> errors_m;
    for (const robot::BodyMarker& marker : model_.body().markers) {
      errors_m.push_back(
          (marker.point.weights.Position(state.x_m) - marker.point.weights.Position(truth_.x_m))
              .norm());
    }
    std::sort(errors_m.begin(), errors_m.end());
    return errors_m[errors_m.size() / 2];
  }

  robot::RobotModel& model() { return model_; }
  const std::vector<FitSite>& sites() const { return sites_; }

 private:
  robot::RobotModel model_;
  std::vector<FitSite> sites_;
  fem::StaticState truth_;
};

void ExpectConvergenceInFourSteps(const robot::RobotDescription& robot) {
  Sweep sweep(robot);
  Config config;
  config.frame_tolerance = 1e-8;
  ForceNewton fitter(sweep.model(), config);
  fitter.SetSites(sweep.sites());
  ModelState state = sweep.Start();
  for (int frame = 1; frame <= Sweep::kFrames; ++frame) {
    sweep.Solve(frame);
    const ForceFit& fit = fitter.Fit(sweep.Targets(), sweep.Cables(frame), &state);
    ASSERT_TRUE(fit.status.ok()) << frame << ' ' << ToString(fit.status.code());
    EXPECT_LE(fit.iterations, 4) << frame;
    EXPECT_EQ(fit.continuation_steps, 0) << frame;
    EXPECT_LE((state.lambda_f_N - Sweep::Forces_N(frame)).norm(), 1e-7) << frame;
  }
}

void ExpectSmallErrorWithOneStepAFrame(const robot::RobotDescription& robot) {
  Sweep sweep(robot);
  Config config;
  config.frame_tolerance = 1e-8;
  config.max_iterations = 1;
  ForceNewton fitter(sweep.model(), config);
  fitter.SetSites(sweep.sites());
  ModelState state = sweep.Start();
  std::vector<double> errors_m;
  for (int frame = 1; frame <= Sweep::kFrames; ++frame) {
    sweep.Solve(frame);
    const ForceFit& fit = fitter.Fit(sweep.Targets(), sweep.Cables(frame), &state);
    ASSERT_TRUE(fit.status.ok() || fit.status.code() == StatusCode::kBudgetReached) << frame;
    EXPECT_EQ(fit.iterations, 1);
    errors_m.push_back(sweep.MedianError_m(state));
  }
  std::sort(errors_m.begin(), errors_m.end());
  EXPECT_LE(errors_m[errors_m.size() / 2], 0.03e-3);
}

TEST(ForceNewtonSweep, ConvergesOnTheDiamondInFourSteps) {
  const auto robot = test_support::DiamondRobot();
  if (!robot) GTEST_SKIP() << "the paper's mesh is not there (PALPATE_DATA_DIR)";
  ExpectConvergenceInFourSteps(*robot);
}

TEST(ForceNewtonSweep, ConvergesOnOurRobotInFourSteps) {
  ExpectConvergenceInFourSteps(test_support::LockingFourLegRobot());
}

/// Frames of a slender body that are seconds apart, in which Newton's method diverges.
TEST(ForceNewtonSweep, WhereInputsJumpTheyAreFollowedFirst) {
  Sweep sweep(test_support::LinearRobot("rod"));
  Config config;
  config.frame_tolerance = 1e-8;
  ForceNewton fitter(sweep.model(), config);
  fitter.SetSites(sweep.sites());
  ModelState state = sweep.Start();
  for (const int frame : {20, 0, 15, 40}) {
    sweep.Solve(frame);
    const ForceFit& fit = fitter.Fit(sweep.Targets(), sweep.Cables(frame), &state);
    ASSERT_TRUE(fit.status.ok()) << frame << ' ' << ToString(fit.status.code());
    EXPECT_EQ(fit.continuation_steps, 0) << frame;
    EXPECT_LE((state.lambda_f_N - Sweep::Forces_N(frame)).norm(), 1e-6) << frame;
  }
}

/// Frames of a running robot have no time for it.
TEST(ForceNewtonSweep, WithoutContinuationStepsADivergingFitEndsAtOnce) {
  Sweep sweep(test_support::LinearRobot("rod"));
  ForceNewton fitter(sweep.model(), {});
  fitter.SetSites(sweep.sites());
  fitter.LimitContinuationSteps(0);
  ModelState state = sweep.Start();
  sweep.Solve(20);
  const int before = sweep.model().linearisation().factor_count();
  const ForceFit& fit = fitter.Fit(sweep.Targets(), sweep.Cables(20), &state);
  EXPECT_FALSE(fit.status.ok());
  EXPECT_LE(sweep.model().linearisation().factor_count() - before, fit.iterations + 1);
}

TEST(ForceNewtonSweep, OneStepAFrameFollowsTheDiamondWithinThreeHundredthsOfAMillimetre) {
  const auto robot = test_support::DiamondRobot();
  if (!robot) GTEST_SKIP() << "the paper's mesh is not there (PALPATE_DATA_DIR)";
  ExpectSmallErrorWithOneStepAFrame(*robot);
}

TEST(ForceNewtonSweep, OneStepAFrameFollowsOurRobotWithinThreeHundredthsOfAMillimetre) {
  ExpectSmallErrorWithOneStepAFrame(test_support::LockingFourLegRobot());
}

}  // namespace
}  // namespace palpate::force_estimation
