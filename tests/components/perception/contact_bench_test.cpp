// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// From frames of the virtual bench to named contacts, with either segmentation. Where the tools
// touch is known from the bench's shapes.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "components/perception/perception.hpp"
#include "libs/geometry/closest_point.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

constexpr double kBallRadius_m = 0.010;

/// The skin's point nearest to the ball's centre, camera frame: deepest in the dent.
Eigen::Vector3d TouchOf(const PredictedSurface& skin, const scenario::Scenario& scenario,
                        const virtual_camera::ToolPose& tool) {
  const geometry::SurfaceIndex index({skin.vertices_m, skin.triangles});
  const geometry::SurfacePoint nearest =
      index.Closest(scenario.camera->T_robot_camera.inverse() * tool.T_robot_tool.translation());
  EXPECT_LT(nearest.distance_m, kBallRadius_m + 5e-4) << "the ball does not touch";
  return nearest.position_m;
}

/// Contacts of `seen` against where the tools of `view` touch.
void ExpectContacts(const Observation& seen, const scenario::Scenario& scenario,
                    const virtual_camera::View& view, double largest_error_m) {
  EXPECT_EQ(seen.contacts.size(), view.tools.size());
  const PredictedSurface skin = Predict(scenario, view.nodes_m);
  for (const virtual_camera::ToolPose& tool : view.tools) {
    const Eigen::Vector3d touch_m = TouchOf(skin, scenario, tool);
    const auto found = std::min_element(
        seen.contacts.begin(), seen.contacts.end(), [&](const auto& a, const auto& b) {
          return (a.position_m - touch_m).norm() < (b.position_m - touch_m).norm();
        });
    ASSERT_NE(found, seen.contacts.end());
    const Eigen::Vector3d off_m = found->position_m - touch_m;
    const double chi_squared = off_m.dot(found->covariance_m2.inverse() * off_m);
    std::cout << tool.tool << ": " << found->name << " is off by " << 1e3 * off_m.norm()
              << " mm, chi^2 " << chi_squared << "\n";
    EXPECT_LT(off_m.norm(), largest_error_m);
    EXPECT_LT(chi_squared, 7.815);
  }
}

TEST(ContactBench, BallsAreLocatedWithBothSegmentations) {
  const scenario::Scenario scenario = PushScenario();
  for (const auto& [recording, t_s] :
       {std::pair("02_push", 2.0), std::pair("03_two_pushes", 4.0)}) {
    const virtual_camera::View rest = PushedView(scenario, recording, 0.0);
    const virtual_camera::View view = PushedView(scenario, recording, t_s);
    const PredictedSurface predicted = Predict(scenario, rest.nodes_m);
    LabelledScene scene(scenario);
    Config config;
    config.tracking.appear_frames = 2;
    Perception by_model(config);
    config.segmentation = "color";
    Perception by_color(config);
    for (Perception* perception : {&by_model, &by_color}) {
      perception->SetCamera(scenario.camera->camera);
    }
    scene.Take(view);
    by_model.Update(scene.frame(), &predicted);
    by_color.Update(scene.frame(), &predicted);
    scene.Take(view);
    for (Perception* perception : {&by_model, &by_color}) {
      const Observation& seen = perception->Update(scene.frame(), &predicted);
      ASSERT_TRUE(seen.frame.status.ok()) << seen.frame.status.message();
      ExpectContacts(seen, scenario, view, 0.005);
    }
  }
}

TEST(ContactBench, AFreeRobotHasNoContacts) {
  const scenario::Scenario scenario = PushScenario();
  virtual_camera::View view = PushedView(scenario, "02_push", 0.0);  // the ball is 30 mm away
  const PredictedSurface predicted = Predict(scenario, view.nodes_m);
  for (const char* segmentation : {"model", "color"}) {
    Config config;
    config.segmentation = segmentation;
    config.tracking.appear_frames = 1;
    Perception perception(config);
    perception.SetCamera(scenario.camera->camera);
    LabelledScene scene(scenario);
    for (int frame = 0; frame < 3; ++frame) {
      scene.Take(view);
      const Observation& seen = perception.Update(scene.frame(), &predicted);
      ASSERT_TRUE(seen.frame.status.ok()) << seen.frame.status.message();
      EXPECT_TRUE(seen.contacts.empty()) << segmentation;
    }
  }
}

}  // namespace
}  // namespace palpate::perception
