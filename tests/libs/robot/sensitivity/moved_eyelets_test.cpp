// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "libs/robot/eyelets.hpp"
#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

constexpr double kRoom_m = 2e-3;

class MovedEyelets : public testing::TestWithParam<fem::ElementType> {
 protected:
  RobotCase WithRoom() const {
    RobotCase robot = robot_;
    GiveEyeletsRoom(kRoom_m, &robot.body);
    return robot;
  }

  RobotCase robot_ = SoftBeam({GetParam(), Control::kDisplacement});
};

TEST_P(MovedEyelets, RoomChangesNothing) {
  const Balance without = Solve(robot_);
  const Balance with = Solve(WithRoom());
  EXPECT_LT((with.state.x_m - without.state.x_m).lpNorm<Eigen::Infinity>(), 1e-11);
  EXPECT_LT((with.Tensions_N() - without.Tensions_N()).lpNorm<Eigen::Infinity>(), 1e-7);
  EXPECT_GT(with.model->cable(0).eyelets()[0].nodes.size(),
            without.model->cable(0).eyelets()[0].nodes.size());
}

/// Wherever it is moved to, whatever it was before.
TEST_P(MovedEyelets, MakeTheModelOfARobotThatHasThemThere) {
  constexpr unsigned kSeed = 11;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> off_m(-kRoom_m, kRoom_m);
  const RobotCase with_room = WithRoom();
  RobotModel moved(with_room.body);
  const fem::PointLocator locator(robot_.body.mesh);
  for (int trial = 0; trial < 10; ++trial) {
    RobotBody there = robot_.body;
    for (const auto& [c, e] : {std::pair{0, 0}, {0, 1}, {0, 2}, {1, 1}}) {
      const Eigen::Vector3d moved_m(off_m(random), off_m(random), off_m(random));
      const Status status = moved.MoveEyelet(c, e, moved_m);
      ASSERT_TRUE(status.ok()) << status.message();
      MoveEyelet(locator, there.scale, e, moved_m, &there.cables[static_cast<size_t>(c)]);
    }
    const RobotModel built(there);
    EXPECT_LT((moved.actuator_rest_m() - built.actuator_rest_m()).norm(), 1e-14);
    Eigen::VectorXd x_m = moved.RestState().x_m;
    for (double& coordinate : x_m) coordinate += 0.1 * off_m(random);
    for (int c = 0; c < moved.CableCount(); ++c) {
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x_m.size());
      moved.cable(c).AddGradient(x_m, 1.0, gradient);
      built.cable(c).AddGradient(x_m, -1.0, gradient);
      EXPECT_LT(gradient.lpNorm<Eigen::Infinity>(), 1e-12) << "cable " << c;
      EXPECT_NEAR(moved.cable(c).Value(x_m), built.cable(c).Value(x_m), 1e-14);
    }
  }
}

/// Newton's method still converges: the stiffness of the moved path goes where it belongs.
TEST_P(MovedEyelets, AreSolvedAsARobotThatHasThemThere) {
  const Eigen::Vector3d moved_m(1e-3, -1.5e-3, 0.5e-3);
  RobotCase there = robot_;
  MoveEyelet(fem::PointLocator(there.body.mesh), 1.0, 1, moved_m, &there.body.cables[0]);
  const Balance built = Solve(there);
  RobotModel moved(WithRoom().body);
  ASSERT_TRUE(moved.MoveEyelet(0, 1, moved_m).ok());
  fem::StaticState state = moved.RestState();
  const fem::StaticResult result = moved.Solve(robot_.cables, robot_.loads, &state);
  ASSERT_TRUE(result.status.ok()) << result.status.message();
  EXPECT_LT((state.x_m - built.state.x_m).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_GT((state.x_m - Solve(robot_).state.x_m).lpNorm<Eigen::Infinity>(), 1e-5);
}

TEST_P(MovedEyelets, BeyondTheirRoomStayWhereTheyAre) {
  RobotModel model(WithRoom().body);
  const Eigen::Vector3d before_m = model.body().cables[0].eyelets[1].rest_m;
  const double rest_length_m = model.actuator_rest_m()[0];
  const Status status = model.MoveEyelet(0, 1, Eigen::Vector3d(0.05, 0.0, 0.0));
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(status.message(), testing::HasSubstr("more than the model has room for"));
  EXPECT_EQ(model.body().cables[0].eyelets[1].rest_m, before_m);
  EXPECT_EQ(model.actuator_rest_m()[0], rest_length_m);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, MovedEyelets,
                         testing::Values(fem::ElementType::kTet4, fem::ElementType::kTet10));

}  // namespace
}  // namespace palpate::robot
