// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>

#include "libs/robot/robot_model.hpp"
#include "tests/support/robots.hpp"

namespace palpate::robot {
namespace {

/// What pressure in all chambers does to the arm, in millimetres, from its shape under its weight.
struct Growth {
  double longer_mm = 0.0;   ///< on its axis
  double thicker_mm = 0.0;  ///< largest radial motion of the skin, away from both ends
};

Growth UnderPressure(const RobotDescription& robot, double pressure_Pa) {
  RobotModel model(BuildRobotBody(robot));
  std::vector<ActuatorCommand> commands(static_cast<size_t>(model.ActuatorCount()));
  fem::StaticState hanging = model.RestState();
  EXPECT_TRUE(model.Solve(commands, {}, &hanging).status.ok());
  for (int a = 0; a < model.ActuatorCount(); ++a) {
    commands[static_cast<size_t>(a)] = {ActuatorCommand::Kind::kTension,
                                        model.traits(a).Force_N(pressure_Pa)};
  }
  fem::StaticState blown = hanging;
  const fem::StaticResult result = model.Solve(commands, {}, &blown);
  EXPECT_TRUE(result.status.ok()) << result.status.message();
  const fem::InterpolationWeights tip = model.locator().Embed({0.0, 0.0, 0.09}).weights;
  Growth growth{1e3 * (tip.Position(blown.x_m) - tip.Position(hanging.x_m)).z()};
  const Eigen::Matrix3Xd& rest_m = model.body().mesh.nodes_m;
  for (Eigen::Index node = 0; node < rest_m.cols(); ++node) {
    const auto before_m = hanging.x_m.segment<3>(3 * node);
    const auto after_m = blown.x_m.segment<3>(3 * node);
    const bool is_skin = rest_m.col(node).head<2>().norm() > 0.0194 && rest_m(2, node) > 0.0225 &&
                         rest_m(2, node) < 0.0675;
    if (!is_skin) continue;
    growth.thicker_mm =
        std::max(growth.thicker_mm, 1e3 * (after_m.head<2>().norm() - before_m.head<2>().norm()));
  }
  return growth;
}

/// A winding turns pressure into length.
TEST(WoundArm, BecomesLongerInPlaceOfThicker) {
  RobotDescription robot = test_support::ReadRobot("wound_arm");
  const Growth wound = UnderPressure(robot, 30e3);
  ASSERT_EQ(robot.fibres.size(), 2u);
  robot.fibres.clear();
  const Growth plain = UnderPressure(robot, 30e3);
  EXPECT_GT(plain.thicker_mm, plain.longer_mm);
  EXPECT_LT(wound.thicker_mm, 0.1 * plain.thicker_mm);
  EXPECT_GT(wound.longer_mm, 3.0 * plain.longer_mm);
  RecordProperty("plain_thicker_um", static_cast<int>(1e3 * plain.thicker_mm));
  RecordProperty("wound_thicker_um", static_cast<int>(1e3 * wound.thicker_mm));
  RecordProperty("plain_longer_um", static_cast<int>(1e3 * plain.longer_mm));
  RecordProperty("wound_longer_um", static_cast<int>(1e3 * wound.longer_mm));
}

}  // namespace
}  // namespace palpate::robot
