// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// From frames of the virtual bench to named contacts, with either segmentation. Where the tools
// touch is known from the bench's shapes.

#include <gtest/gtest.h>

#include "components/perception/perception.hpp"
#include "tests/components/perception/labelled_scene.hpp"
#include "tests/components/perception/touch_of.hpp"

namespace palpate::perception {
namespace {

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
