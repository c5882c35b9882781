// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Balls that hide their contact, and all of the robot near it, from a camera that looks along the
// robot's normal.

#include <gtest/gtest.h>

#include <memory>

#include "components/perception/perception.hpp"
#include "libs/scenario/scenario_sections.hpp"
#include "tests/components/perception/labelled_scene.hpp"
#include "tests/components/perception/touch_of.hpp"

namespace palpate::perception {
namespace {

/// The robot from above, a ball `gap_m` over the top of its hub.
struct FromAbove {
  FromAbove(double radius_m, double gap_m) : scenario{PushScenario()} {
    scenario.camera->T_robot_camera = scenario::LookAt({0.02, -0.01, 0.60}, {0.0, 0.0, 0.1});
    scenario.tools.resize(1);
    scenario.tools[0].radius_m = radius_m;
    view = RestView(scenario);
    const double top_m = view.nodes_m.row(2).maxCoeff();
    view.tools.push_back({scenario.tools[0].name, Eigen::Isometry3d::Identity()});
    view.tools[0].T_robot_tool.translation() = Eigen::Vector3d(0.0, 0.0, top_m + radius_m + gap_m);
  }

  /// What perception sees in the first frame.
  Observation Look() {
    Config config;
    config.tracking.appear_frames = 1;
    auto segmenter = std::make_unique<ModelSegmenter>(config);
    const ModelSegmenter& by_model = *segmenter;
    Perception perception(config, std::move(segmenter));
    perception.SetCamera(scenario.camera->camera);
    LabelledScene scene(scenario);
    scene.Take(view);
    const PredictedSurface predicted = Predict(scenario, view.nodes_m);
    Observation seen = perception.Update(scene.frame(), &predicted);
    DrawLabels("large_ball", scene, by_model.region());
    EXPECT_TRUE(seen.frame.status.ok()) << seen.frame.status.message();
    return seen;
  }

  scenario::Scenario scenario;
  virtual_camera::View view;
};

class LargeBalls : public testing::TestWithParam<double> {};

TEST_P(LargeBalls, AreContactsWhereTheyTouch) {
  FromAbove scene(GetParam(), -2e-4);
  ExpectContacts(scene.Look(), scene.scenario, scene.view, 0.005);
}

TEST_P(LargeBalls, AreNoneWhereTheyDoNot) {
  EXPECT_TRUE(FromAbove(GetParam(), 0.006).Look().contacts.empty());
}

INSTANTIATE_TEST_SUITE_P(OfRadius, LargeBalls, testing::Values(0.012, 0.020, 0.025, 0.030));

}  // namespace
}  // namespace palpate::perception
