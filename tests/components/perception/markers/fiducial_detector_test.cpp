// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Discs that the virtual camera draws on the four-legged robot, nine of them where four_leg.yaml
// has its markers.

#include "components/perception/markers/fiducial_detector.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/components/perception/markers/fiducial_score.hpp"

namespace palpate::perception {
namespace {

using scenario::Scenario;

/// From the south-east, lower and higher, and from above: each marker is in view of one of them.
constexpr double kAzimuths_deg[] = {-30.0, 20.0, 40.0, 110.0, 150.0, 240.0};
constexpr double kHeights_deg[] = {28.0, 55.0, 88.0};
constexpr double kDistance_m = 0.45;

FiducialScore ScoreFrom(double azimuth_deg, double height_deg, Scenario scenario, int seeds,
                        const FiducialConfig& config) {
  PlaceCamera(kDistance_m, azimuth_deg, height_deg, &scenario);
  return DetectOn(scenario, config, seeds);
}

FiducialScore ScoreAllRound(const Scenario& scenario) {
  FiducialScore all;
  for (const double azimuth_deg : kAzimuths_deg) {
    for (const double height_deg : kHeights_deg) {
      all += ScoreFrom(azimuth_deg, height_deg, scenario, 1, ConfigOf(scenario));
    }
  }
  std::printf("%s\n", all.Text().c_str());
  return all;
}

void ExpectAccurate(const FiducialScore& score) {
  EXPECT_EQ(score.found, score.in_view);
  EXPECT_EQ(score.false_ones, 0);
  EXPECT_LE(score.LateralRms_m(), 0.3e-3);
  EXPECT_LE(score.worst_depth_sigmas, 3.0);
}

TEST(FiducialDetector, FindsTheMarkersInViewAllRoundAndNoOthers) {
  const FiducialScore score = ScoreAllRound(MarkedScenario());
  ExpectAccurate(score);
  EXPECT_GE(score.in_view, 36);
  EXPECT_EQ(score.markers_found.size(), 9u) << "each from somewhere";
}

TEST(FiducialDetector, FindsMarkersOfSixMillimetres) {
  Scenario scenario = MarkedScenario();
  scenario.stage.marker_radius_m = 0.003;
  ExpectAccurate(ScoreAllRound(scenario));
}

TEST(FiducialDetector, FindsMarkersOfFourMillimetresFromNearer) {
  Scenario scenario = MarkedScenario();
  scenario.stage.marker_radius_m = 0.002;
  PlaceCamera(0.3, -30.0, 50.0, &scenario);
  const FiducialScore score = DetectOn(scenario, ConfigOf(scenario), 5);
  EXPECT_GE(score.in_view, 15);
  EXPECT_GE(score.found, score.in_view - 1) << "holes in the depth may open the rim of one";
  EXPECT_EQ(score.false_ones, 0);
  EXPECT_LE(score.LateralRms_m(), 0.1e-3);
}

/// Discs stick to the skin, their covariance is theirs: as wide as what they are really off by.
TEST(FiducialDetector, CovarianceIsHonest) {
  const Scenario scenario = MarkedScenario();
  FiducialConfig config = ConfigOf(scenario);
  // The renderer's noise is alike by exp(-(d / c)^2), the noise law's by exp(-d^2 / (2 c^2)).
  config.noise.correlation_px = scenario.camera->noise.correlation_px / std::sqrt(2.0);
  FiducialScore score;
  constexpr int kSeeds = 15;
  for (const double height_deg : {28.0, 50.0}) {
    score += ScoreFrom(-30.0, height_deg, scenario, kSeeds, config);
  }
  std::printf("%s\n", score.Text().c_str());
  EXPECT_EQ(score.found, score.in_view);
  EXPECT_GT(score.MeanMahalanobis(), 2.0);
  EXPECT_LT(score.MeanMahalanobis(), 4.0);
  EXPECT_GT(score.MeanDepthSigmas(), 0.6);
  EXPECT_LT(score.MeanDepthSigmas(), 1.4);
}

TEST(FiducialDetector, FindsNothingWhereThereAreNoMarkers) {
  Scenario scenario = MarkedScenario();
  scenario.stage.marker_radius_m = 0.0;
  const FiducialScore score = ScoreAllRound(scenario);
  EXPECT_EQ(score.found + score.others + score.false_ones, 0);
}

TEST(FiducialDetector, ColorCameraOfItsOwn) {
  Scenario scenario = MarkedScenario();
  rgbd::RgbdCamera& camera = scenario.camera->camera;
  camera.color = {.width_px = 1280,
                  .height_px = 720,
                  .fx_px = 900.0,
                  .fy_px = 900.0,
                  .cx_px = 639.5,
                  .cy_px = 359.5};
  camera.color_registered = false;
  camera.T_depth_color.translation() = Eigen::Vector3d(0.025, 0.0, 0.0);
  ExpectAccurate(ScoreAllRound(scenario));
}

TEST(FiducialDetector, DepthWithoutNoiseInMillimetres) {
  Scenario scenario = MarkedScenario();
  scenario.camera->noise.sensor = scenario::DepthSensor::kNone;
  scenario.camera->camera.depth_unit_m = 1e-3;
  ExpectAccurate(ScoreAllRound(scenario));
}

TEST(FiducialDetector, ShadeDoesNotCount) {
  for (const double light : {0.35, 1.1}) {
    Scenario scenario = MarkedScenario();
    scenario.stage.light = light;
    ExpectAccurate(ScoreAllRound(scenario));
  }
}

/// What is seen of it is another spot: it is given up, or its place is said to be less sure.
TEST(FiducialDetector, AMarkerThatABallCoversInPartIsRejectedOrLessSure) {
  const Scenario scenario = MarkedScenario();
  MarkedScene scene(FourLegSurface(), scenario);
  FiducialDetector detector(ConfigOf(scenario));
  detector.SetCamera(scenario.camera->camera);
  scene.Take(scene.Rest());
  const std::vector<TrueMarker> truth = scene.truth();
  int whole = 0, gone = 0;
  for (int step = 0; step <= 24; ++step) {
    for (const TrueMarker& marker : truth) {
      if (!marker.in_view) continue;
      virtual_camera::View view = scene.Rest();
      view.tools.push_back({"blue_ball", Eigen::Isometry3d::Identity()});
      const Eigen::Vector3d beside_m(0.026 - 0.001 * step, 0.0, -0.015);
      view.tools[0].T_robot_tool.translation() =
          view.T_robot_camera * (marker.position_m + beside_m);
      const FiducialFrame& found = detector.Detect(scene.Take(view));
      bool seen = false;
      for (const Fiducial& fiducial : found.fiducials) {
        const Eigen::Vector3d off_m = fiducial.position_m - marker.position_m;
        if (off_m.norm() > 6e-3) continue;
        seen = true;
        EXPECT_LT(Mahalanobis(fiducial, marker), 16.0) << "step " << step;
      }
      whole += seen ? 1 : 0;
      gone += seen ? 0 : 1;
    }
  }
  std::printf("%d seen, %d given up\n", whole, gone);
  EXPECT_GE(whole, 10);
  EXPECT_GE(gone, 10);
}

TEST(FiducialDetector, AToolOfTheirColorIsTooLarge) {
  const Scenario scenario = MarkedScenario();
  MarkedScene scene(FourLegSurface(), scenario);
  FiducialDetector detector(ConfigOf(scenario));
  detector.SetCamera(scenario.camera->camera);
  virtual_camera::View view = scene.Rest();
  const std::size_t without = detector.Detect(scene.Take(view)).fiducials.size();
  view.tools.push_back({"green_ball", Eigen::Isometry3d::Identity()});
  view.tools[0].T_robot_tool.translation() = Eigen::Vector3d(0.02, -0.02, 0.18);
  const FiducialFrame& found = detector.Detect(scene.Take(view));
  EXPECT_EQ(found.fiducials.size(), without);
  EXPECT_EQ(found.rejected.too_large, 1);
}

TEST(FiducialDetector, TheSameFrameGivesTheSameBits) {
  const Scenario scenario = MarkedScenario();
  MarkedScene scene(FourLegSurface(), scenario);
  const rgbd::RgbdFrame& frame = scene.Take(scene.Rest());
  FiducialDetector one(ConfigOf(scenario)), other(ConfigOf(scenario));
  one.SetCamera(scenario.camera->camera);
  other.SetCamera(scenario.camera->camera);
  one.Detect(frame);
  const auto& first = one.Detect(frame).fiducials;
  const auto& second = other.Detect(frame).fiducials;
  ASSERT_EQ(first.size(), second.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].position_m, second[i].position_m);
    EXPECT_EQ(first[i].covariance_m2, second[i].covariance_m2);
  }
}

}  // namespace
}  // namespace palpate::perception
