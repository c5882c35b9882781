// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// What is wrong with a frame, a prediction or settings is said, and the next good frame is taken.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "components/perception/model/model_segmenter.hpp"
#include "libs/core/error.hpp"
#include "libs/scenario/scenario_sections.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

class ModelSegmenterRefuses : public testing::Test {
 protected:
  ModelSegmenterRefuses() { scene.Take(RestView(scenario)); }

  void ExpectRefusal(const rgbd::RgbdFrame& frame, const PredictedSurface& surface,
                     StatusCode code) {
    const SegmentedFrame& refused = segmenter.Segment(frame, &surface);
    EXPECT_EQ(refused.status.code(), code) << refused.status.message();
    EXPECT_FALSE(refused.status.message().empty());
    EXPECT_EQ(refused.robot.Count() + refused.object.Count(), 0);
    EXPECT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok()) << "good frames go on";
  }

  scenario::Scenario scenario = PushScenario();
  LabelledScene scene{scenario};
  PredictedSurface predicted = Predict(scenario, PushSkin().rest_m);
  ReadySegmenter segmenter{scenario};
};

TEST_F(ModelSegmenterRefuses, EmptyImages) {
  rgbd::RgbdFrame frame = scene.frame();
  frame.depth = {};
  ExpectRefusal(frame, predicted, StatusCode::kInvalidInput);
  frame = scene.frame();
  frame.color = {};
  ExpectRefusal(frame, predicted, StatusCode::kInvalidInput);
}

TEST_F(ModelSegmenterRefuses, ImagesOfAnotherSize) {
  rgbd::RgbdFrame frame = scene.frame();
  frame.depth = rgbd::DepthImage(640, 480, 4500);
  ExpectRefusal(frame, predicted, StatusCode::kInvalidInput);
  frame = scene.frame();
  frame.color = rgbd::ColorImage(640, 480);
  ExpectRefusal(frame, predicted, StatusCode::kInvalidInput);
}

TEST_F(ModelSegmenterRefuses, DepthWithoutAnyValue) {
  rgbd::RgbdFrame frame = scene.frame();
  std::fill(frame.depth.values.begin(), frame.depth.values.end(), std::uint16_t{0});
  ExpectRefusal(frame, predicted, StatusCode::kNoRobotSeen);
  std::fill(frame.depth.values.begin(), frame.depth.values.end(), std::uint16_t{65535});
  ExpectRefusal(frame, predicted, StatusCode::kNoRobotSeen);
}

TEST_F(ModelSegmenterRefuses, AUnitOfDepthThatIsWrongWithItsFactor) {
  for (const bool too_near : {true, false}) {
    rgbd::RgbdFrame frame = scene.frame();
    for (std::uint16_t& value : frame.depth.values) {
      const int scaled = too_near ? (value + 5) / 10 : 10 * value;
      value = static_cast<std::uint16_t>(scaled > 65535 ? 0 : scaled);
    }
    const Status& status = segmenter.Segment(frame, &predicted).status;
    EXPECT_EQ(status.code(), StatusCode::kNoRobotSeen);
    EXPECT_THAT(status.message(),
                testing::ContainsRegex(too_near ? "(9\\.[5-9]|10).* times too near"
                                                : "(9\\.[5-9]|10).* times too far"));
    EXPECT_THAT(status.message(), testing::HasSubstr("unit_m of camera.yaml"));
  }
  EXPECT_TRUE(segmenter.Segment(scene.frame(), &predicted).status.ok()) << "good frames go on";
}

TEST_F(ModelSegmenterRefuses, ACameraThatIsTurnedAway) {
  LabelledScene elsewhere(scenario);
  virtual_camera::View away = RestView(scenario);
  away.T_robot_camera = scenario::LookAt({0.343, -0.198, 0.275}, {0.8, -0.9, 0.065});
  elsewhere.Take(away);
  ExpectRefusal(elsewhere.frame(), predicted, StatusCode::kNoRobotSeen);
}

TEST_F(ModelSegmenterRefuses, AFrameOfNothingButAWall) {
  rgbd::RgbdFrame frame = scene.frame();
  std::fill(frame.depth.values.begin(), frame.depth.values.end(), std::uint16_t{4500});
  ExpectRefusal(frame, predicted, StatusCode::kNoRobotSeen);
}

TEST_F(ModelSegmenterRefuses, APredictionThatIsNone) {
  PredictedSurface surface = predicted;
  surface.vertices_m(1, 7) = std::numeric_limits<double>::quiet_NaN();
  ExpectRefusal(scene.frame(), surface, StatusCode::kInvalidInput);
  surface = predicted;
  surface.triangles(0, 0) = static_cast<int>(surface.vertices_m.cols());
  ExpectRefusal(scene.frame(), surface, StatusCode::kInvalidInput);
  ExpectRefusal(scene.frame(), {}, StatusCode::kInvalidInput);
}

TEST_F(ModelSegmenterRefuses, APredictionThatIsNotInView) {
  PredictedSurface surface = predicted;
  surface.vertices_m.row(0).array() += 5.0;
  ExpectRefusal(scene.frame(), surface, StatusCode::kNoRobotSeen);
  surface = predicted;
  surface.vertices_m.row(2).array() -= 2.0;  // behind the camera
  ExpectRefusal(scene.frame(), surface, StatusCode::kNoRobotSeen);
}

TEST_F(ModelSegmenterRefuses, AColorThatIsNone) {
  Config config;
  config.robot_color_rgb = {0.5, 0.5};
  EXPECT_THROW(ModelSegmenter{config}, InputError);
}

}  // namespace
}  // namespace palpate::perception
