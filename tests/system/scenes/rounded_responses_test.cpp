// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/robot/compliance.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {
namespace {

/// No next residual corrects what a frame makes of responses: rounding must be far below the
/// model's own error (shape.model_relative_sigma, 3 %).
TEST(SinglePrecisionResponses, ErrFarLessThanTheModel) {
  robot::RobotModel model(robot::BuildRobotBody(FourLegRobot()));
  fem::StaticState state = model.RestState();
  std::vector<robot::ActuatorCommand> cables(static_cast<size_t>(model.ActuatorCount()),
                                             {robot::ActuatorCommand::Kind::kDisplacement, 0.003});
  ASSERT_TRUE(model.Solve(cables, {}, &state).status.ok());
  fem::Linearisation& linearisation = model.linearisation();
  const auto update = [&] {
    return linearisation.Update(state.x_m, state.multipliers_N, state.loads.external_force_N).ok();
  };
  ASSERT_TRUE(update());
  std::vector<robot::ForceDirection> pushes;
  for (const auto& point : model.body().feature_points) {
    constexpr double kAboveClamp_m = 0.03;
    if (point.rest_m.z() < kAboveClamp_m) continue;
    const auto axis = static_cast<Eigen::Index>(pushes.size() % 3);
    pushes.push_back({point.weights, Eigen::Vector3d::Unit(axis)});
  }
  ASSERT_GT(pushes.size(), 20U);
  Eigen::MatrixXd forces(linearisation.Size(), std::ssize(pushes));
  Eigen::VectorXd nodal(state.x_m.size());
  for (Eigen::Index c = 0; c < forces.cols(); ++c) {
    nodal.setZero();
    pushes[static_cast<size_t>(c)].AddForce(1.0, nodal);
    linearisation.matrix().Reduce(nodal, forces.col(c));
  }
  Eigen::MatrixXd exact = forces;
  linearisation.Solve(exact);
  linearisation.KeepSinglePrecision();
  ASSERT_TRUE(update());
  Eigen::MatrixXd rounded = forces;
  linearisation.SolveSingle(rounded);
  ASSERT_NE(rounded, exact);
  const Eigen::ArrayXd error =
      ((rounded - exact).colwise().norm().array() / exact.colwise().norm().array()).transpose();
  EXPECT_LT(error.maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace palpate::test_support
