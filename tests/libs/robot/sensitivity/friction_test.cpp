// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>

#include "libs/robot/sensitivity/eyelet_gradient.hpp"
#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

class Friction : public SensitivityCase {
 protected:
  void SetFriction(double mu) { robot_.friction = {{mu}, {mu, {-1.0}}, {0.5 * mu}}; }
  Change Rubbing(int cable) const {
    return [=, this](double by) {
      RobotCase robot = robot_;
      robot.friction[static_cast<size_t>(cable)].coefficient += by;
      return robot;
    };
  }
};

TEST_P(Friction, Coefficient) {
  SetFriction(0.2);
  for (const int c : {0, 1}) {
    ExpectDerivative(robot_, CableFrictionCoefficient(c), Rubbing(c), 1e-3);
  }
}

/// What one eyelet alone has of friction, of a cable that sticks.
TEST_P(Friction, AtOneEyelet) {
  SetFriction(0.2);
  const std::size_t count = robot_.body.cables[0].eyelets.size();
  robot_.friction[0].sliding.assign(count, 0.3);
  for (std::size_t e = 0; e + 1 < count; ++e) {
    ExpectDerivative(
        robot_, CableFrictionAt(0, static_cast<int>(e)),
        [&](double by) {
          RobotCase robot = robot_;
          robot.friction[0].sliding[e] += by / robot.friction[0].coefficient;
          return robot;
        },
        1e-3);
  }
}

/// At mu = 0 only one side can be re-solved: one-sided differences of order 3.
TEST_P(Friction, CoefficientAtZero) {
  for (const int c : {0, 1}) {
    for (const double sliding : {1.0, -1.0}) {
      robot_.friction[static_cast<size_t>(c)] = {0.0, {sliding}};
      Balance balance = Solve(robot_);
      const Derivative derivative = Differentiate(balance, robot_, CableFrictionCoefficient(c));
      const double step = 1e-3;
      const Eigen::VectorXd expected =
          (-11.0 * balance.Points_m() + 18.0 * Solve(Rubbing(c)(step)).Points_m() -
           9.0 * Solve(Rubbing(c)(2.0 * step)).Points_m() +
           2.0 * Solve(Rubbing(c)(3.0 * step)).Points_m()) /
          (6.0 * step);
      ASSERT_GT(expected.norm(), 0.0);
      EXPECT_LE((derivative.points_m - expected).norm(), 1e-6 * expected.norm());
    }
  }
}

/// Friction makes the equations unsymmetric, which every parameter must see.
TEST_P(Friction, OfOtherCablesAndOfEverythingElse) {
  SetFriction(0.3);
  const auto with = [&](const std::function<void(RobotCase*, double)>& change) {
    return [&, change](double by) {
      RobotCase robot = robot_;
      change(&robot, by);
      return robot;
    };
  };
  ExpectDerivative(robot_, YoungsModulus(0), with([](RobotCase* robot, double by) {
                     robot->body.materials[0].youngs_modulus_Pa += by;
                   }),
                   100.0);
  const Eigen::Vector3d direction = Eigen::Vector3d(0.2, 0.9, -0.4).normalized();
  ExpectDerivative(robot_, PullPointMove(0, direction), with([&](RobotCase* robot, double by) {
                     robot->body.cables[0].pull_point_m += by * direction;
                   }),
                   2e-5);
  const fem::PointLocator locator(robot_.body.mesh);
  const Eigen::Vector3d eyelet_m = SoftBeamGuides().eyelets_m[0].col(1);
  const double radius_m = SoftBeamGuides().radius_m;
  ExpectDerivative(
      robot_, EyeletMove(0, 1, EyeletWeightsAlong(locator, eyelet_m, radius_m, direction)),
      with([&](RobotCase* robot, double by) {
        robot->body.cables[0].eyelets[1] = locator.EmbedBall(eyelet_m + by * direction, radius_m);
      }),
      2e-6);
  ExpectDerivative(robot_, BaseTranslation(direction), with([&](RobotCase* robot, double by) {
                     for (Eigen::Index k = 0; k < robot->held_motion_m.size(); ++k) {
                       robot->held_motion_m[k] += by * direction[k % 3];
                     }
                   }),
                   2e-5);
}

/// The static solver knows the symmetric part of the tangent only.
TEST_P(Friction, EquilibriaAreReached) {
  for (const double mu : {0.1, 0.3, 0.6}) {
    SetFriction(mu);
    const Balance balance = Solve(robot_);
    fem::Linearisation& linearisation = balance.model->linearisation();
    ASSERT_TRUE(linearisation
                    .UpdateResidual(balance.state.x_m, balance.state.multipliers_N,
                                    balance.state.loads.external_force_N)
                    .ok());
    EXPECT_LE(linearisation.residual_N().norm(), 1e-11 * linearisation.internal_force_norm_N());
  }
}

/// The far end is pulled less where the cable is drawn in, more where it is let out.
TEST_P(Friction, TakesPullFromTheFarEndOrAddsToIt) {
  const double without = Solve(robot_).Points_m()[0];
  robot_.friction[0] = {0.3};
  const double drawn_in = Solve(robot_).Points_m()[0];
  robot_.friction[0] = {0.3, {-1.0}};
  const double let_out = Solve(robot_).Points_m()[0];
  EXPECT_GT(std::abs(drawn_in - without), 1e-6);
  EXPECT_LT((drawn_in - without) * (let_out - without), 0.0);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, Friction, AllCases());

}  // namespace
}  // namespace palpate::robot
