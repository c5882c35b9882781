// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/frame_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libs/core/statistics.hpp"
#include "tests/support/random_loading.hpp"
#include "tests/support/robots.hpp"

namespace palpate::robot {
namespace {

constexpr auto kPull = ActuatorCommand::Kind::kDisplacement;

/// A robot whose first cable goes to 20 mm and back by 1 mm a frame while a force on its highest
/// point changes.
class Sweep {
 public:
  explicit Sweep(const RobotDescription& robot, const fem::SolverSettings& solver = {})
      : model_{BuildRobotBody(robot), {}, solver} {
    Eigen::Index highest = 0;
    model_.body().mesh.nodes_m.row(2).maxCoeff(&highest);
    patch_ = model_.Patch(model_.body().mesh.nodes_m.col(highest), 0.005).weights;
    truth_ = model_.RestState();
    Solve(0);
  }

  static constexpr int kFrames = 40;
  std::vector<ActuatorCommand> Cables(int frame) const {
    std::vector<ActuatorCommand> cables(static_cast<size_t>(model_.ActuatorCount()), {kPull, 0.0});
    cables[0].value = 1e-3 * (frame <= 20 ? frame : 40 - frame);
    return cables;
  }
  Eigen::Vector3d Force_N(int frame) const {
    return {0.2 * std::sin(0.3 * frame), 0.1, -0.3 * std::cos(0.2 * frame)};
  }
  Eigen::VectorXd NodalForce_N(int frame) const {
    Eigen::VectorXd nodal_N = Eigen::VectorXd::Zero(truth_.x_m.size());
    for (size_t k = 0; k < patch_.nodes.size(); ++k) {
      nodal_N.segment<3>(3 * patch_.nodes[k]) = patch_.weights[k] * Force_N(frame);
    }
    return nodal_N;
  }
  /// Moves truth() to the equilibrium of the frame.
  void Solve(int frame) {
    const fem::StaticResult result =
        model_.Solve(Cables(frame), {{patch_, Force_N(frame)}}, &truth_);
    ASSERT_TRUE(result.status.ok()) << result.status.message();
  }
  /// Median distance of the feature points from where the truth has them.
  double MedianError_m(const fem::StaticState& state) const {
    std::vector<double> errors_m;
    for (const fem::BodyPoint& point : model_.body().feature_points) {
      errors_m.push_back(
          (point.weights.Position(state.x_m) - point.weights.Position(truth_.x_m)).norm());
    }
    return UpperMedian(errors_m);
  }

  RobotModel& model() { return model_; }
  const fem::StaticState& truth() const { return truth_; }

 private:
  RobotModel model_;
  fem::InterpolationWeights patch_;
  fem::StaticState truth_;
};

/// All feature points after the first ten frames, each converged, one after another.
Eigen::VectorXd PathOfFeaturePoints(const RobotDescription& robot,
                                    const fem::SolverSettings& solver) {
  Sweep sweep(robot, solver);
  FrameTracker tracker(sweep.model(), {.relative_tolerance = 1e-11});
  tracker.Start(sweep.truth());
  std::vector<double> path_m;
  for (int frame = 1; frame <= 10; ++frame) {
    EXPECT_TRUE(tracker.Follow(sweep.Cables(frame), sweep.NodalForce_N(frame)).converged());
    for (const fem::BodyPoint& point : sweep.model().body().feature_points) {
      const Eigen::Vector3d position_m = point.weights.Position(tracker.state().x_m);
      path_m.insert(path_m.end(), position_m.begin(), position_m.end());
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(path_m.data(), static_cast<Eigen::Index>(path_m.size()));
}

TEST(FrameTracker, FollowsAlikeOnAnyNumberOfThreads) {
  const RobotDescription robot = test_support::LockingFourLegRobot();
  const Eigen::VectorXd alone_m = PathOfFeaturePoints(robot, {.threads = 1});
  for (const int threads : {2, 3}) {
    const Eigen::VectorXd path_m = PathOfFeaturePoints(robot, {.threads = threads});
    ASSERT_EQ(path_m.size(), alone_m.size());
    EXPECT_LE((path_m - alone_m).norm(), 1e-12 * alone_m.norm()) << threads << " threads";
  }
}

TEST(FrameTracker, FollowsAlikeWithEachSolver) {
  const RobotDescription robot = test_support::LockingFourLegRobot();
  const Eigen::VectorXd expected_m = PathOfFeaturePoints(robot, {.solver = "cholmod_simplicial"});
  for (const char* solver : {"multifrontal", "cholmod_supernodal"}) {
    const Eigen::VectorXd path_m = PathOfFeaturePoints(robot, {.solver = solver});
    EXPECT_LE((path_m - expected_m).norm(), 1e-9 * expected_m.norm()) << solver;
  }
}

void ExpectConvergenceInFourSteps(const RobotDescription& robot) {
  Sweep sweep(robot);
  FrameTracker tracker(sweep.model(), {.relative_tolerance = 1e-8});
  tracker.Start(sweep.truth());
  for (int frame = 1; frame <= Sweep::kFrames; ++frame) {
    const fem::FrameOutcome outcome =
        tracker.Follow(sweep.Cables(frame), sweep.NodalForce_N(frame));
    ASSERT_TRUE(outcome.converged()) << frame << ' ' << ToString(outcome.status.code());
    EXPECT_LE(outcome.error, 1e-8);
    EXPECT_LE(outcome.exact_steps, 4) << frame;
    sweep.Solve(frame);
    EXPECT_LE(sweep.MedianError_m(tracker.state()), 1e-8) << frame;
  }
}

void ExpectSmallErrorWithOneStepAFrame(const RobotDescription& robot) {
  Sweep sweep(robot);
  FrameTracker tracker(sweep.model(), {.relative_tolerance = 1e-8, .max_exact_steps = 1});
  tracker.Start(sweep.truth());
  std::vector<double> errors_m;
  for (int frame = 1; frame <= Sweep::kFrames; ++frame) {
    const fem::FrameOutcome outcome =
        tracker.Follow(sweep.Cables(frame), sweep.NodalForce_N(frame));
    ASSERT_FALSE(outcome.diverged()) << frame << ' ' << ToString(outcome.status.code());
    EXPECT_EQ(outcome.exact_steps, 1);
    sweep.Solve(frame);
    errors_m.push_back(sweep.MedianError_m(tracker.state()));
  }
  std::sort(errors_m.begin(), errors_m.end());
  EXPECT_LE(errors_m[errors_m.size() / 2], 0.03e-3);
  EXPECT_GT(errors_m.back(), 1e-8) << "the frames were converged: nothing was shown";
}

TEST(FrameTracker, ConvergesOnTheDiamondInFourStepsWhileACableMovesOneMillimetreAFrame) {
  const std::optional<RobotDescription> robot = test_support::DiamondRobot();
  if (!robot) GTEST_SKIP() << "the paper's mesh is not there (PALPATE_DATA_DIR)";
  ExpectConvergenceInFourSteps(*robot);
}

TEST(FrameTracker, ConvergesOnOurRobotInFourStepsWhileACableMovesOneMillimetreAFrame) {
  ExpectConvergenceInFourSteps(test_support::LockingFourLegRobot());
}

TEST(FrameTracker, OneExactStepAFrameFollowsTheDiamondWithinThreeHundredthsOfAMillimetre) {
  const std::optional<RobotDescription> robot = test_support::DiamondRobot();
  if (!robot) GTEST_SKIP() << "the paper's mesh is not there (PALPATE_DATA_DIR)";
  ExpectSmallErrorWithOneStepAFrame(*robot);
}

TEST(FrameTracker, OneExactStepAFrameFollowsOurRobotWithinThreeHundredthsOfAMillimetre) {
  ExpectSmallErrorWithOneStepAFrame(test_support::LockingFourLegRobot());
}

TEST(FrameTracker, KeepsTheLastGoodStateApart) {
  Sweep sweep(test_support::LockingFourLegRobot());
  FrameTracker tracker(sweep.model(), {.relative_tolerance = 1e-8, .max_exact_steps = 1});
  tracker.Start(sweep.truth());
  const Eigen::VectorXd good_m = sweep.truth().x_m;
  Eigen::VectorXd force_N = sweep.NodalForce_N(5);
  ASSERT_EQ(tracker.Follow(sweep.Cables(5), force_N).status.code(), StatusCode::kBudgetReached);
  EXPECT_NE(tracker.state().x_m, good_m);
  EXPECT_EQ(tracker.last_good().x_m, good_m);
  force_N[7] = std::nan("");
  EXPECT_TRUE(tracker.Follow(sweep.Cables(5), force_N).diverged());
  EXPECT_EQ(tracker.last_good().x_m, good_m);
  EXPECT_EQ(tracker.state().x_m, good_m);
  force_N = sweep.NodalForce_N(5);
  fem::FrameOutcome outcome;
  for (int frame = 0; frame < 6 && !outcome.converged(); ++frame) {
    outcome = tracker.Follow(sweep.Cables(5), force_N);
  }
  EXPECT_TRUE(outcome.converged());
  EXPECT_NE(tracker.last_good().x_m, good_m);
}

TEST(FrameTracker, SaysThatACableIsAtItsLimit) {
  RobotDescription robot = test_support::LockingFourLegRobot();
  robot.cables[0].max_tension_N = 0.5;
  Sweep sweep(robot);
  FrameTracker tracker(sweep.model(), {.relative_tolerance = 1e-8});
  tracker.Start(sweep.truth());
  const Eigen::VectorXd good_m = tracker.last_good().x_m;
  const fem::FrameOutcome outcome = tracker.Follow(sweep.Cables(15), sweep.NodalForce_N(0));
  EXPECT_EQ(outcome.status.code(), StatusCode::kTensionLimit);
  EXPECT_EQ(tracker.last_good().x_m, good_m);
}

}  // namespace
}  // namespace palpate::robot
