// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/touches/touch_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/palpate/touches/touch_scenario.hpp"
#include "libs/app/yaml.hpp"
#include "libs/scenario/robot_names.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

/// The touches of each robot of config/robots, of linear elements.
class Touches : public testing::TestWithParam<const char*> {
 protected:
  Touches()
      : description_(test_support::QuickRobot(GetParam())),
        model_(robot::BuildRobotBody(description_)),
        plan_(PlanTouches(&model_)),
        diagonal_m_(geometry::BoundingBox(model_.body().mesh.nodes_m).Diagonal_m()) {}

  double DistanceToBody_m(const Eigen::Vector3d& point_m) const {
    return model_.locator().Distance_m(point_m);
  }

  scenario::Scenario Written() const {
    const auto file = folder_.Write("touches.yaml", TouchScenario(model_.body(), plan_));
    return scenario::ReadScenario(file, app::LoadYaml);
  }

  test_support::TestFolder folder_;
  robot::RobotDescription description_;
  robot::RobotModel model_;
  TouchPlan plan_;
  double diagonal_m_;
};

TEST_P(Touches, TheCameraSeesAllOfTheBody) {
  const scenario::Scenario scenario = Written();
  ASSERT_TRUE(scenario.camera);
  const rgbd::CameraModel& camera = scenario.camera->camera.depth;
  const Eigen::Matrix3Xd seen_m =
      scenario.camera->T_robot_camera.inverse() * model_.body().mesh.nodes_m;
  Eigen::Vector2d lowest_px(1e9, 1e9), highest_px(-1e9, -1e9);
  for (const auto& point_m : seen_m.colwise()) {
    ASSERT_GT(point_m.z(), 0.1);
    const Eigen::Vector2d px(camera.fx_px * point_m.x() / point_m.z() + camera.cx_px,
                             camera.fy_px * point_m.y() / point_m.z() + camera.cy_px);
    lowest_px = lowest_px.cwiseMin(px);
    highest_px = highest_px.cwiseMax(px);
  }
  EXPECT_GT(lowest_px.minCoeff(), 0.0);
  EXPECT_LT(highest_px.x(), camera.width_px);
  EXPECT_LT(highest_px.y(), camera.height_px);
  // It fills a good part of the image.
  EXPECT_GT((highest_px - lowest_px).maxCoeff(), 0.25 * camera.height_px);
}

TEST_P(Touches, BallsComeFromOutsideAndPressIn) {
  for (const Touch& touch : {plan_.visible, plan_.hidden.value_or(plan_.visible)}) {
    EXPECT_GT(touch.force_N, 0.0);
    EXPECT_GT(DistanceToBody_m(touch.away_m), 2.0 * plan_.ball_radius_m);
    EXPECT_GT(DistanceToBody_m(touch.near_m), 0.9 * plan_.ball_radius_m);
    const double pressed_m = (touch.pressed_m - touch.near_m).norm();
    EXPECT_GT(pressed_m, 0.01 * diagonal_m_);
    EXPECT_LT(pressed_m, 2.0 * kLongTouchMotion * diagonal_m_ + plan_.ball_radius_m);
  }
}

TEST_P(Touches, TheVisiblePlaceFacesTheCameraAndTheHiddenOneDoesNot) {
  const auto facing = [&](const Touch& touch) {
    const Eigen::Vector3d outward = (touch.away_m - touch.near_m).normalized();
    return outward.dot((plan_.T_robot_camera.translation() - touch.near_m).normalized());
  };
  EXPECT_GT(facing(plan_.visible), 0.2);
  if (plan_.hidden) {
    EXPECT_LT(facing(*plan_.hidden), 0.0);
  }
}

TEST_P(Touches, TheScenarioIsOfTheRobotAndUsesEveryActuator) {
  const scenario::Scenario scenario = Written();
  EXPECT_NO_THROW(scenario::CheckAgainst(scenario, scenario::NamesOf(description_)));
  EXPECT_EQ(static_cast<int>(plan_.settings.size()), model_.ActuatorCount());
  for (const ActuatorSetting& setting : plan_.settings) {
    EXPECT_GT(setting.value, 0.0) << setting.name;
  }
  EXPECT_EQ(plan_.driven.has_value(), model_.ActuatorCount() > 0);
}

INSTANTIATE_TEST_SUITE_P(Robots, Touches,
                         testing::Values("pneumatic_finger", "pneumatic_arm", "four_leg", "beam",
                                         "rod"),
                         [](const auto& robot) { return robot.param; });

}  // namespace
}  // namespace palpate::command
