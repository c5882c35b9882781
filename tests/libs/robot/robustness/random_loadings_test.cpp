// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/robot/frame_tracker.hpp"
#include "tests/support/random_loading.hpp"
#include "tests/support/robots.hpp"

namespace palpate::robot {
namespace {

using test_support::FrameTally;
using test_support::RandomLoading;

constexpr double kTolerance = 1e-8;
constexpr int kMostExactSteps = 12;

/// Residual over the size of the forces, and cable length missed over the shortest cable, of what
/// a tracker calls an equilibrium, found without it.
double ErrorOf(RobotModel& model, const fem::StaticState& state) {
  fem::Linearisation& linearisation = model.linearisation();
  const Status status =
      linearisation.UpdateResidual(state.x_m, state.multipliers_N, state.loads.external_force_N);
  EXPECT_TRUE(status.ok()) << ToString(status.code());
  double missed_m = 0.0;
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const fem::ConstraintCommand& command = state.loads.commands[static_cast<size_t>(c)];
    if (command.mode != fem::ConstraintCommand::Mode::kUpperBound) continue;
    const double excess_m = model.cable(c).Value(state.x_m) - command.value;
    const double tension_N = state.multipliers_N[c];
    EXPECT_GE(tension_N, 0.0);
    missed_m = std::max(missed_m, tension_N > 0.0 ? std::abs(excess_m) : excess_m);
  }
  const double scale_N = fem::ForceScale_N(linearisation, state.loads, state.multipliers_N);
  return std::max(linearisation.residual_N().norm() / scale_N,
                  missed_m / model.actuator_rest_m().minCoeff());
}

bool IsFinite(const fem::StaticState& state) {
  return state.x_m.allFinite() && state.multipliers_N.allFinite();
}

void RunLoading(RobotModel& model, const RandomLoading& loading, const fem::StaticState& at_rest,
                FrameTracker* tracker, FrameTally* tally) {
  const fem::InterpolationWeights patch =
      model.Patch(loading.point_m, loading.patch_radius_m).weights;
  tracker->Start(at_rest);
  Eigen::VectorXd force_N(at_rest.x_m.size());
  for (int k = 1; k <= loading.frames; ++k) {
    force_N.setZero();
    for (size_t i = 0; i < patch.nodes.size(); ++i) {
      force_N.segment<3>(3 * patch.nodes[i]) +=
          patch.weights[i] * loading.force_N * k / loading.frames;
    }
    const fem::FrameOutcome& outcome = tracker->Follow(loading.Cables(k), force_N);
    ASSERT_TRUE(IsFinite(tracker->state()));
    ASSERT_TRUE(IsFinite(tracker->last_good()));
    ASSERT_LE(ErrorOf(model, tracker->last_good()), 1.01 * kTolerance);
    if (outcome.converged()) {
      ASSERT_LE(ErrorOf(model, tracker->state()), 1.01 * kTolerance);
      ASSERT_EQ(tracker->state().loads.commands.size(), loading.cables_m.size());
    } else {
      ASSERT_GT(outcome.diverged() ? 1.0 : outcome.error, kTolerance);
    }
    ++(outcome.converged()  ? tally->converged
       : outcome.diverged() ? tally->diverged
                            : tally->budget);
    tally->exact_steps += outcome.exact_steps;
    tally->most_exact_steps = std::max(tally->most_exact_steps, outcome.exact_steps);
  }
}

void RunLoadings(const std::string& name, const RobotDescription& robot, int by_default) {
  RobotModel model(BuildRobotBody(robot));
  fem::StaticState at_rest = model.RestState();
  const std::vector<ActuatorCommand> slack(static_cast<size_t>(model.ActuatorCount()));
  ASSERT_TRUE(model.Solve(slack, {}, &at_rest).status.ok());
  FrameTracker tracker(model,
                       {.relative_tolerance = kTolerance, .max_exact_steps = kMostExactSteps});
  const test_support::LoadingRange range = test_support::LoadingsToRun(by_default);
  FrameTally tally;
  for (int index = range.first; index < range.end; ++index) {
    SCOPED_TRACE("PALPATE_LOADING=" + std::to_string(index));
    RunLoading(model, test_support::MakeRandomLoading(model, index), at_rest, &tracker, &tally);
    if (testing::Test::HasFatalFailure()) return;
  }
  tally.Print(name, range.end - range.first);
  // Without this the test would pass where nothing converges.
  EXPECT_GE(tally.converged, 0.8 * tally.frames());
}

TEST(RandomLoadings, EveryFrameOfTheDiamondConvergesOrSaysThatItDidNot) {
  const std::optional<RobotDescription> robot = test_support::DiamondRobot();
  if (!robot) GTEST_SKIP() << "the paper's mesh is not there (PALPATE_DATA_DIR)";
  RunLoadings("diamond", *robot, 60);
}

TEST(RandomLoadings, EveryFrameOfOurRobotConvergesOrSaysThatItDidNot) {
  RunLoadings("four_leg", test_support::LockingFourLegRobot(), 60);
}

}  // namespace
}  // namespace palpate::robot
