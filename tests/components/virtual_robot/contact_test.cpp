// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/components/virtual_robot/bench_setup.hpp"

namespace palpate::virtual_robot::test {
namespace {

scenario::Tool Sphere(double radius_m, double friction) {
  scenario::Tool tool;
  tool.name = "finger";
  tool.radius_m = radius_m;
  tool.friction_coefficient = friction;
  return tool;
}

/// A block that lies on its clamped face x = 0; pressed along -x.
scenario::Scenario PressedBy(const scenario::Tool& tool) {
  scenario::Scenario scenario = PlainScenario();
  scenario.tools = {tool};
  return scenario;
}

TEST(Shapes, GradientOfTheDistanceIsTheNormalAndItsDerivativeTheCurvature) {
  std::vector<scenario::Tool> tools(3, Sphere(0.01, 0.0));
  tools[1].shape = scenario::ToolShape::kCylinder;
  tools[1].length_m = 0.03;
  tools[2].shape = scenario::ToolShape::kPlate;
  tools[2].size_m = {0.02, 0.03, 0.006};
  for (const scenario::Tool& tool : tools) {
    const RigidShape shape(tool);
    for (const Eigen::Vector3d& at_m :
         {Eigen::Vector3d(0.012, 0.003, 0.0013), Eigen::Vector3d(0.008, 0.007, 0.0155),
          Eigen::Vector3d(-0.0105, 0.0155, -0.0035), Eigen::Vector3d(0.002, -0.004, 0.0145)}) {
      const Clearance clearance = shape.Measure(at_m);
      EXPECT_NEAR(clearance.normal.norm(), 1.0, 1e-12);
      for (int i = 0; i < 3; ++i) {
        constexpr double kStep_m = 1e-7;
        const Eigen::Vector3d step_m = kStep_m * Eigen::Vector3d::Unit(i);
        const Clearance plus = shape.Measure(at_m + step_m);
        const Clearance minus = shape.Measure(at_m - step_m);
        EXPECT_NEAR((plus.distance_m - minus.distance_m) / (2.0 * kStep_m), clearance.normal[i],
                    1e-6);
        EXPECT_LE(
            ((plus.normal - minus.normal) / (2.0 * kStep_m) - clearance.curvature.col(i)).norm(),
            1e-4 * (1.0 + clearance.curvature.norm()));
      }
    }
  }
}

TEST(ContactOfTools, SphereOnABlockPressesAsHertzSays) {
  constexpr double kRadius_m = 0.03;
  constexpr double kDepth_m = 0.0008;
  const Eigen::Vector3d size_m(0.04, 0.05, 0.05);
  VirtualRobot robot(BoxRobot({6, 8, 8}, size_m), PressedBy(Sphere(kRadius_m, 0.0)), {}, 1);
  Inputs inputs = NoInputs(0);
  inputs.tools = {At("finger", {0.04 + kRadius_m + 1e-4, 0.025, 0.025})};
  ASSERT_TRUE(robot.Start(0.0, inputs).ok());
  EXPECT_TRUE(robot.forces().empty());
  inputs.tools = {At("finger", {0.04 + kRadius_m - kDepth_m, 0.025, 0.025})};
  ASSERT_TRUE(robot.Advance(0.1, inputs).ok());
  ASSERT_EQ(robot.forces().size(), 1U);
  const TrueForce force = robot.forces().front();
  constexpr double kNu = 0.3;
  const double plane_Pa = 1e5 / (1.0 - kNu * kNu);
  const double hertz_N = 4.0 / 3.0 * plane_Pa * std::sqrt(kRadius_m) * std::pow(kDepth_m, 1.5);
  // The block is glued to its ground: E. K. Dimitriadis et al., Determination of elastic moduli of
  // thin layers of soft material using the atomic force microscope, Biophys. J. 82, 2002, eq. 12.
  const double chi = std::sqrt(kRadius_m * kDepth_m) / size_m.x();
  const double alpha = -(1.2876 - 1.4678 * kNu + 1.3442 * kNu * kNu) / (1.0 - kNu);
  const double layer = 1.0 - 2.0 * alpha / M_PI * chi + std::pow(2.0 * alpha / M_PI * chi, 2.0);
  EXPECT_NEAR(-force.force_N.x() / (hertz_N * layer), 1.0, 0.03);
  EXPECT_LE(force.force_N.tail<2>().norm(), 0.01 * hertz_N);
  EXPECT_LE((force.rest_position_m - Eigen::Vector3d(0.04, 0.025, 0.025)).norm(), 3e-4);
  EXPECT_NEAR(force.position_m.x(), 0.04 - kDepth_m, 3e-4);
}

/// Pulls with a moving tool; gives its force after each step.
class Sliding : public ::testing::Test {
 protected:
  static constexpr double kFriction = 0.4;
  static constexpr double kDepth_m = 0.001;

  TrueForce MoveTo(double t_s, double y_m) {
    Inputs inputs = NoInputs(0);
    inputs.tools = {At("finger", {0.03 + 0.01 - kDepth_m, y_m, 0.015})};
    EXPECT_TRUE(robot_.Advance(t_s, inputs).ok()) << y_m;
    return robot_.forces().empty() ? TrueForce{} : robot_.forces().front();
  }
  void SetUp() override {
    Inputs inputs = NoInputs(0);
    inputs.tools = {At("finger", {0.03 + 0.0101, 0.012, 0.015})};
    ASSERT_TRUE(robot_.Start(0.0, inputs).ok());
  }

  VirtualRobot robot_{
      BoxRobot({5, 5, 5}, {0.03, 0.03, 0.03}), PressedBy(Sphere(0.01, kFriction)), {}, 1};
};

TEST_F(Sliding, SticksFirstAndThenSlipsAtCoulombsBound) {
  const TrueForce pressed = MoveTo(0.1, 0.012);
  EXPECT_LT(pressed.force_N.x(), -0.1);
  double t_s = 0.1;
  double before_N = 0.0;
  TrueForce force;
  for (int k = 1; k <= 30; ++k) {
    t_s += 1.0 / 60.0;
    force = MoveTo(t_s, 0.012 + 2e-4 * k);
    const double normal_N = -force.force_N.x();
    EXPECT_LE(std::abs(force.force_N.y()), 1.3 * kFriction * normal_N) << k;
    if (k <= 3) {
      EXPECT_GT(force.force_N.y(), before_N) << k;
      before_N = force.force_N.y();
    }
  }
  EXPECT_NEAR(force.force_N.y() / -force.force_N.x(), kFriction, 0.3 * kFriction);
}

TEST_F(Sliding, ForceOfTheToolIsCarriedByTheClamp) {
  MoveTo(0.1, 0.012);
  const TrueForce force = MoveTo(0.2, 0.013);
  EXPECT_GT(force.force_N.norm(), 0.1);
  EXPECT_LE((robot_.SupportForce_N() - force.force_N).norm(), 1e-3 * force.force_N.norm());
}

TEST_F(Sliding, LetsGoWhereTheToolLeaves) {
  MoveTo(0.1, 0.012);
  ASSERT_TRUE(robot_.Advance(0.2, NoInputs(0)).ok());
  EXPECT_TRUE(robot_.forces().empty());
  EXPECT_LE((robot_.positions_m() - robot_.mesh().nodes_m.reshaped()).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(ContactOfTools, ABentBeamThatCatchesUpWithItsToolNeedsFewFactors) {
  constexpr double kPeriod_s = 1.0 / 30.0;
  constexpr double kTouching_m = 0.02 + 0.01;
  VirtualRobot robot(BoxRobot({10, 3, 3}, {0.1, 0.02, 0.02}), PressedBy(Sphere(0.01, 0.3)), {}, 1);
  int frame = 0;
  const auto move_to = [&](double z_m) {
    Inputs inputs = NoInputs(0);
    inputs.tools = {At("finger", {0.09, 0.01, z_m})};
    if (frame == 0) return robot.Start(0.0, inputs);
    return robot.Advance(frame * kPeriod_s, inputs);
  };
  for (; frame <= 40; ++frame) ASSERT_TRUE(move_to(kTouching_m - 3e-4 * (frame - 1)).ok());
  for (; frame <= 43; ++frame) ASSERT_TRUE(move_to(kTouching_m - 3e-4 * 39).ok());
  ASSERT_EQ(robot.forces().size(), 1U);
  // The ball goes back by ten times its depth in the body: the beam springs after it.
  const int before = robot.cost().factorisations;
  ASSERT_TRUE(move_to(kTouching_m - 3e-4 * 38).ok());
  EXPECT_EQ(robot.forces().size(), 1U);
  EXPECT_LE(robot.cost().factorisations - before, 5);
}

TEST(ContactOfTools, DoesNotEnterDeeperThanItsLawSays) {
  const robot::RobotDescription box = BoxRobot({5, 5, 5}, {0.03, 0.03, 0.03});
  scenario::Tool plate = Sphere(0.01, 0.3);
  plate.shape = scenario::ToolShape::kPlate;
  plate.size_m = {0.01, 0.06, 0.06};
  VirtualRobot robot(box, PressedBy(plate), {}, 1);
  Inputs inputs = NoInputs(0);
  inputs.tools = {At("finger", {0.03 + 0.0051, 0.015, 0.015})};
  ASSERT_TRUE(robot.Start(0.0, inputs).ok());
  inputs.tools = {At("finger", {0.03 + 0.005 - 0.006, 0.015, 0.015})};
  ASSERT_TRUE(robot.Advance(0.3, inputs).ok());
  Eigen::Index middle = 0;
  (robot.mesh().nodes_m.colwise() - Eigen::Vector3d(0.03, 0.015, 0.015))
      .colwise()
      .squaredNorm()
      .minCoeff(&middle);
  const double deep_m = robot.positions_m()[3 * middle] - 0.024;
  EXPECT_GE(deep_m, 10e-6);
  EXPECT_LE(deep_m, 50e-6);
}

}  // namespace
}  // namespace palpate::virtual_robot::test
