// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// What is no marker, and why: shapes painted on a flat wall that faces the camera.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "components/perception/markers/fiducial_detector.hpp"
#include "libs/core/error.hpp"

namespace palpate::perception {
namespace {

constexpr int kWidth_px = 160, kHeight_px = 120;
constexpr double kFocal_px = 400.0;
constexpr int kWall_mm = 400;  ///< a pixel is 1 mm there

rgbd::RgbdCamera Camera() {
  rgbd::RgbdCamera camera;
  camera.depth = {.width_px = kWidth_px,
                  .height_px = kHeight_px,
                  .fx_px = kFocal_px,
                  .fy_px = kFocal_px,
                  .cx_px = 79.5,
                  .cy_px = 59.5};
  camera.depth_unit_m = 1e-3;
  camera.baseline_m = 0.05;
  camera.color = camera.depth;
  camera.color_registered = true;
  return camera;
}

FiducialConfig GreenConfig() {
  FiducialConfig config;
  config.color_rgb = {0.1, 0.7, 0.2};
  return config;
}

/// A grey wall.
rgbd::RgbdFrame Obstacle() {
  rgbd::RgbdFrame frame;
  frame.depth = rgbd::DepthImage(kWidth_px, kHeight_px, kWall_mm);
  frame.color = rgbd::ColorImage(kWidth_px, kHeight_px, 150);
  return frame;
}

struct Rgb {
  double red, green, blue;
};
constexpr Rgb kGreenDisc{26, 178, 51};

/// Each pixel takes of `rgb` the share of it that lies in a shape: its points at 5 x 5 places.
void Paint(const std::function<bool(double u, double v)>& inside, const Rgb& rgb,
           rgbd::ColorImage* image) {
  constexpr int kPlaces = 5;
  for (int v = 0; v < image->height_px; ++v) {
    for (int u = 0; u < image->width_px; ++u) {
      int hits = 0;
      for (int k = 0; k < kPlaces * kPlaces; ++k) {
        const double du = (k % kPlaces - 2) / 5.0, dv = (k / kPlaces - 2) / 5.0;
        hits += inside(u + du, v + dv) ? 1 : 0;
      }
      const double share = hits / 25.0;
      const double to[3] = {rgb.red, rgb.green, rgb.blue};
      for (int k = 0; k < 3; ++k) {
        std::uint8_t& value = image->Pixel(u, v)[k];
        value = static_cast<std::uint8_t>(std::lround(value + share * (to[k] - value)));
      }
    }
  }
}

std::function<bool(double, double)> Disc(double u_px, double v_px, double radius_px) {
  return [=](double u, double v) { return std::hypot(u - u_px, v - v_px) < radius_px; };
}

const FiducialFrame& DetectIn(const rgbd::RgbdFrame& frame,
                              const FiducialConfig& config = GreenConfig()) {
  static std::unique_ptr<FiducialDetector> detector;
  detector = std::make_unique<FiducialDetector>(config);
  detector->SetCamera(Camera());
  return detector->Detect(frame);
}

/// Nothing found, and one spot rejected, for this reason.
void ExpectRejected(const FiducialFrame& found, int FiducialRejections::*reason) {
  EXPECT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_TRUE(found.fiducials.empty());
  EXPECT_EQ(found.rejected.*reason, 1);
  EXPECT_EQ(found.rejected.Count(), 1);
}

TEST(FiducialRefusals, ADiscOnAWallIsFoundToAFractionOfAPixel) {
  for (const double offset : {0.0, 0.2, 0.4, 0.6, 0.8}) {
    rgbd::RgbdFrame frame = Obstacle();
    Paint(Disc(70.0 + offset, 50.0 - 0.5 * offset, 3.4), kGreenDisc, &frame.color);
    const FiducialFrame& found = DetectIn(frame);
    ASSERT_EQ(found.fiducials.size(), 1u);
    const Fiducial& disc = found.fiducials[0];
    EXPECT_NEAR(disc.pixel_px.x(), 70.0 + offset, 0.03);
    EXPECT_NEAR(disc.pixel_px.y(), 50.0 - 0.5 * offset, 0.03);
    EXPECT_NEAR(disc.radius_px, 3.4, 0.15);
    EXPECT_NEAR(disc.radius_m, 3.4e-3, 0.15e-3);
    const Eigen::Vector3d place_m(0.4 * (70.0 + offset - 79.5) / kFocal_px,
                                  0.4 * (50.0 - 0.5 * offset - 59.5) / kFocal_px, 0.4);
    EXPECT_LT((disc.position_m - place_m).norm(), 0.05e-3);
    EXPECT_GT(disc.contrast, 0.35);
    EXPECT_EQ(disc.open_rim, 0.0);
  }
}

TEST(FiducialRefusals, EachOfSeveralColors) {
  FiducialConfig config = GreenConfig();
  config.color_rgb.insert(config.color_rgb.end(), {0.1, 0.2, 0.9});
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(50.0, 40.0, 3.4), {26, 51, 230}, &frame.color);
  Paint(Disc(90.0, 80.0, 3.4), kGreenDisc, &frame.color);
  const FiducialFrame& found = DetectIn(frame, config);
  ASSERT_EQ(found.fiducials.size(), 2u);
  EXPECT_EQ(found.fiducials[0].color, 1);
  EXPECT_EQ(found.fiducials[1].color, 0);
}

TEST(FiducialRefusals, AColorThatOnlyOneHasTellsItsName) {
  FiducialConfig config = GreenConfig();
  config.color_rgb.insert(config.color_rgb.end(), {0.1, 0.2, 0.9, 0.9, 0.1, 0.1});
  config.names = {"tip", "leg", "foot"};
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(50.0, 40.0, 3.4), {26, 51, 230}, &frame.color);
  Paint(Disc(90.0, 80.0, 3.4), kGreenDisc, &frame.color);
  Paint(Disc(50.0, 90.0, 3.4), kGreenDisc, &frame.color);
  const FiducialFrame& found = DetectIn(frame, config);
  ASSERT_EQ(found.fiducials.size(), 3u);
  EXPECT_EQ(found.fiducials[0].name, "leg");
  EXPECT_EQ(found.fiducials[1].name, "") << "two are green";
  EXPECT_EQ(found.fiducials[2].name, "");
}

TEST(FiducialRefusals, TooSmall) {
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(70.0, 50.0, 0.8), kGreenDisc, &frame.color);
  ExpectRejected(DetectIn(frame), &FiducialRejections::too_small);
  frame = Obstacle();
  Paint(Disc(70.0, 50.0, 2.5), kGreenDisc, &frame.color);
  FiducialConfig config = GreenConfig();
  config.min_radius_m = config.max_radius_m = 0.004;
  ExpectRejected(DetectIn(frame, config), &FiducialRejections::too_small);
}

TEST(FiducialRefusals, TooLarge) {
  for (const double radius_px : {5.4, 20.0}) {
    rgbd::RgbdFrame frame = Obstacle();
    Paint(Disc(70.0, 50.0, radius_px), kGreenDisc, &frame.color);
    ExpectRejected(DetectIn(frame), &FiducialRejections::too_large);
  }
}

TEST(FiducialRefusals, NotRound) {
  const std::function<bool(double, double)> shapes[] = {
      [](double u, double v) { return std::abs(u - 70.0) < 4.2 && std::abs(v - 50.0) < 1.8; },
      [](double u, double v) { return std::hypot(u - 70.0, v - 50.0) < 4.2 && u > 70.0; },
      [](double u, double v) {  // a ring in which the wall is seen
        const double r = std::hypot(u - 70.0, v - 50.0);
        return r < 4.4 && r > 2.6;
      }};
  for (const auto& shape : shapes) {
    rgbd::RgbdFrame frame = Obstacle();
    Paint(shape, kGreenDisc, &frame.color);
    ExpectRejected(DetectIn(frame), &FiducialRejections::not_round);
  }
}

TEST(FiducialRefusals, WithoutDepthOrOutOfRange) {
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(70.0, 50.0, 3.4), kGreenDisc, &frame.color);
  rgbd::RgbdFrame holes = frame;
  for (int v = 46; v < 55; ++v) {
    for (int u = 66; u < 75; ++u) *holes.depth.Pixel(u, v) = 0;
  }
  ExpectRejected(DetectIn(holes), &FiducialRejections::no_depth);
  FiducialConfig config = GreenConfig();
  config.max_z_m = 0.3;
  ExpectRejected(DetectIn(frame, config), &FiducialRejections::no_depth);
}

TEST(FiducialRefusals, AtAnEdge) {
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(4.0, 50.0, 3.4), kGreenDisc, &frame.color);
  ExpectRejected(DetectIn(frame), &FiducialRejections::at_edge);  // of the picture
  frame = Obstacle();
  Paint(Disc(70.0, 50.0, 3.4), kGreenDisc, &frame.color);
  for (int v = 0; v < kHeight_px; ++v) {
    for (int u = 74; u < kWidth_px; ++u) *frame.depth.Pixel(u, v) = 450;
  }
  EXPECT_EQ(DetectIn(frame).fiducials.size(), 0u);  // of what it is on
  ExpectRejected(DetectIn(frame), &FiducialRejections::at_edge);
}

TEST(FiducialRefusals, OfTheColorOfWhatIsRoundIt) {
  rgbd::RgbdFrame frame = Obstacle();
  Paint([](double, double) { return true; }, {70, 130, 80}, &frame.color);
  Paint(Disc(70.0, 50.0, 3.4), kGreenDisc, &frame.color);
  FiducialConfig config = GreenConfig();
  config.color_tolerance = 0.15;
  EXPECT_EQ(DetectIn(frame, config).rejected.wrong_color, 0);
  config.min_contrast = 0.6;
  ExpectRejected(DetectIn(frame, config), &FiducialRejections::wrong_color);
}

TEST(FiducialRefusals, DarkOnesAndOtherColorsAreNoSpots) {
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(70.0, 50.0, 3.4), {2, 14, 4}, &frame.color);
  Paint(Disc(40.0, 50.0, 3.4), {200, 30, 30}, &frame.color);
  const FiducialFrame& found = DetectIn(frame);
  EXPECT_EQ(found.fiducials.size(), 0u);
  EXPECT_EQ(found.rejected.Count(), 0);
}

TEST(FiducialRefusals, OpenRimsMakeThePlaceLessSure) {
  rgbd::RgbdFrame frame = Obstacle();
  Paint(Disc(70.0, 50.0, 3.4), kGreenDisc, &frame.color);
  const Eigen::Matrix3d whole_m2 = DetectIn(frame).fiducials.at(0).covariance_m2;
  for (int v = 0; v < kHeight_px; ++v) {
    for (int u = 77; u < kWidth_px; ++u) *frame.depth.Pixel(u, v) = 450;
  }
  const Fiducial open = DetectIn(frame).fiducials.at(0);
  EXPECT_GT(open.open_rim, 0.02);
  EXPECT_GT(open.covariance_m2(0, 0), 1.5 * whole_m2(0, 0));
}

TEST(FiducialRefusals, FramesOfAnotherSizeAndCamerasWithoutColors) {
  rgbd::RgbdFrame frame = Obstacle();
  frame.color = rgbd::ColorImage(10, 10);
  EXPECT_EQ(DetectIn(frame).status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(DetectIn(frame).status.message(), testing::HasSubstr("10x10"));
  rgbd::RgbdCamera camera = Camera();
  camera.color = {};
  FiducialDetector detector(GreenConfig());
  detector.SetCamera(camera);
  EXPECT_EQ(detector.Detect(Obstacle()).status.code(), StatusCode::kInvalidInput);
  EXPECT_THAT(detector.Detect(Obstacle()).status.message(), testing::HasSubstr("no colours"));
}

std::string RefusalOf(const FiducialConfig& config) {
  try {
    FiducialDetector detector(config);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FiducialRefusals, SettingsThatCannotBe) {
  EXPECT_THAT(RefusalOf({}), testing::HasSubstr("color_rgb has 0 numbers"));
  FiducialConfig config = GreenConfig();
  config.color_rgb.push_back(0.5);
  EXPECT_THAT(RefusalOf(config), testing::HasSubstr("color_rgb has 4 numbers"));
  config = GreenConfig();
  config.color_rgb = {0.0, 0.0, 0.0};
  EXPECT_THAT(RefusalOf(config), testing::HasSubstr("black"));
  config = GreenConfig();
  config.min_radius_m = 0.005;
  EXPECT_THAT(RefusalOf(config), testing::HasSubstr("min_radius_m is 0.005"));
  config = GreenConfig();
  config.min_z_m = 3.0;
  EXPECT_THAT(RefusalOf(config), testing::HasSubstr("min_z_m is 3"));
  config = GreenConfig();
  config.names = {"tip", "leg"};
  EXPECT_THAT(RefusalOf(config), testing::HasSubstr("names has 2 markers, color_rgb 1"));
  config.color_rgb.insert(config.color_rgb.end(), {0.1, 0.2, 0.9});
  config.names = {"tip", "tip"};
  EXPECT_THAT(RefusalOf(config), testing::HasSubstr("names has 'tip' twice"));
}

}  // namespace
}  // namespace palpate::perception
