// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>

#include "components/perception/registered_frame.hpp"

namespace palpate::perception {
namespace {

constexpr std::uint16_t kNear = 3000;  // 0.3 m
constexpr std::uint16_t kFar = 9000;   // 0.9 m

/// The colour camera stands 30 mm to the right of the depth camera and has another focal length.
rgbd::RgbdCamera TwoCameras() {
  rgbd::RgbdCamera camera;
  camera.depth = {.width_px = 160,
                  .height_px = 120,
                  .fx_px = 140.0,
                  .fy_px = 140.0,
                  .cx_px = 79.5,
                  .cy_px = 59.5};
  camera.color = {.width_px = 200,
                  .height_px = 150,
                  .fx_px = 180.0,
                  .fy_px = 180.0,
                  .cx_px = 99.5,
                  .cy_px = 74.5};
  camera.T_depth_color.translation() = Eigen::Vector3d(0.03, 0.0, 0.0);
  return camera;
}

/// A far wall, and a near square before its middle.
rgbd::RgbdFrame SquareBeforeObstacle(const rgbd::RgbdCamera& camera) {
  rgbd::RgbdFrame frame;
  frame.depth = rgbd::DepthImage(camera.depth.width_px, camera.depth.height_px, kFar);
  for (int v = 40; v < 80; ++v) {
    for (int u = 60; u < 100; ++u) *frame.depth.Pixel(u, v) = kNear;
  }
  frame.color = rgbd::ColorImage(camera.color.width_px, camera.color.height_px);
  return frame;
}

/// What the colour camera sees of that: the square red, the wall blue by its place on it.
void Paint(const rgbd::RgbdCamera& camera, rgbd::RgbdFrame* frame) {
  const double left = -19.5 / 140.0 * 0.3, right = 20.5 / 140.0 * 0.3;
  for (int v = 0; v < camera.color.height_px; ++v) {
    for (int u = 0; u < camera.color.width_px; ++u) {
      const Eigen::Vector3d ray = rgbd::Unproject(camera.color, Eigen::Vector2d(u, v));
      const double x = 0.3 * ray.x() + 0.03, y = 0.3 * ray.y();
      const bool on_square = x > left && x < right && y > left && y < right;
      std::uint8_t* rgb = frame->color.Pixel(u, v);
      rgb[0] = on_square ? 200 : 0;
      rgb[2] = on_square ? 0 : static_cast<std::uint8_t>(100 + u / 2);
    }
  }
}

struct Registered {
  explicit Registered(const rgbd::RgbdCamera& camera, const rgbd::RgbdFrame& frame)
      : registration(camera) {
    status = registration.Register(frame, &result);
  }
  const std::uint8_t* Color(int u, int v) const { return result.color.Pixel(u, v); }
  bool Known(int u, int v) const {
    return result.color_known[static_cast<std::size_t>(v * result.color.width_px + u)] != 0;
  }

  Registration registration;
  RegisteredFrame result;
  Status status;
};

TEST(Registration, BringsColorsToTheirDepthPixels) {
  const rgbd::RgbdCamera camera = TwoCameras();
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  Paint(camera, &frame);
  const Registered seen(camera, frame);
  ASSERT_TRUE(seen.status.ok()) << seen.status.message();
  EXPECT_EQ(seen.Color(80, 60)[0], 200) << "on the square";
  EXPECT_FLOAT_EQ(*seen.result.z_m.Pixel(80, 60), 0.3f);
  // The wall left of the square: x = (u - cx) z / f, seen 0.03 m farther left by the other camera.
  for (const int u : {10, 30, 120, 150}) {
    const double x_m = (u - 79.5) / 140.0 * 0.9;
    const double u_color = 180.0 * (x_m - 0.03) / 0.9 + 99.5;
    ASSERT_TRUE(seen.Known(u, 20)) << u;
    EXPECT_EQ(seen.Color(u, 20)[2], 100 + static_cast<int>(std::lround(u_color)) / 2) << u;
  }
}

TEST(Registration, GivesNoColorOfANearerSurfaceToWhatItHides) {
  const rgbd::RgbdCamera camera = TwoCameras();
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  Paint(camera, &frame);
  const Registered seen(camera, frame);
  int hidden = 0;
  for (int u = 20; u < 140; ++u) {  // in view of both
    const bool wall = *seen.result.z_m.Pixel(u, 60) > 0.5f;
    if (!wall) continue;
    EXPECT_EQ(seen.Color(u, 60)[0], 0) << "red of the square on the wall, at " << u;
    hidden += seen.Known(u, 60) ? 0 : 1;
  }
  // The parallax f b (1/0.3 - 1/0.9) in depth pixels.
  EXPECT_NEAR(hidden, 140.0 * 0.03 * (1.0 / 0.3 - 1.0 / 0.9), 3.0);
}

TEST(Registration, KnowsNoColorBesideThePictureOrWithoutDepth) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.color.fx_px = camera.color.fy_px = 400.0;  // sees less than the depth camera
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  *frame.depth.Pixel(80, 60) = 0;
  const Registered seen(camera, frame);
  EXPECT_FALSE(seen.Known(0, 0));
  EXPECT_FALSE(seen.Known(159, 119));
  EXPECT_FALSE(seen.Known(80, 60));
  EXPECT_TRUE(std::isnan(*seen.result.z_m.Pixel(80, 60)));
  EXPECT_TRUE(seen.Known(90, 60));
}

TEST(Registration, FollowsTheLensOfTheColorCamera) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.color.distortion = {-0.2, 0.05, 0.001, -0.001, 0.0};
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  for (int v = 0; v < camera.color.height_px; ++v) {
    for (int u = 0; u < camera.color.width_px; ++u) {
      frame.color.Pixel(u, v)[0] = static_cast<std::uint8_t>(u);
      frame.color.Pixel(u, v)[1] = static_cast<std::uint8_t>(v);
    }
  }
  const Registered seen(camera, frame);
  for (const auto& [u, v] : {std::pair(20, 15), std::pair(140, 100), std::pair(75, 110)}) {
    const Eigen::Vector3d point_m = 0.9 * rgbd::Unproject(camera.depth, Eigen::Vector2d(u, v)) -
                                    Eigen::Vector3d(0.03, 0.0, 0.0);
    const Eigen::Vector2d pixel = rgbd::Project(camera.color, point_m);
    ASSERT_TRUE(seen.Known(u, v));
    EXPECT_NEAR(seen.Color(u, v)[0], pixel.x(), 0.51);
    EXPECT_NEAR(seen.Color(u, v)[1], pixel.y(), 0.51);
  }
}

TEST(Registration, GivesTheDepthOfOnePixelAsItDoesAll) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.invalid_value = 7;
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  *frame.depth.Pixel(3, 2) = 7;
  *frame.depth.Pixel(4, 2) = 0;
  const Registration registration(camera);
  RegisteredFrame whole;
  ASSERT_TRUE(registration.RegisterDepth(frame, &whole).ok());
  int seen = 0;
  for (int v = 0; v < camera.depth.height_px; ++v) {
    for (int u = 0; u < camera.depth.width_px; ++u) {
      const float all_m = *whole.z_m.Pixel(u, v), one_m = registration.Depth_m(frame, u, v);
      ASSERT_TRUE(all_m == one_m || (std::isnan(all_m) && std::isnan(one_m))) << u << ", " << v;
      seen += one_m > 0.0f ? 1 : 0;
    }
  }
  EXPECT_TRUE(std::isnan(registration.Depth_m(frame, 3, 2)));
  EXPECT_TRUE(std::isnan(registration.Depth_m(frame, 4, 2)));
  EXPECT_GT(seen, 0);
}

TEST(Registration, RegistersAPartAsItDoesTheWhole) {
  const rgbd::RgbdCamera camera = TwoCameras();
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  Paint(camera, &frame);
  const Registered whole(camera, frame);
  Registration registration(camera);
  RegisteredFrame part;
  ASSERT_TRUE(registration.RegisterDepth(frame, &part).ok());
  registration.RegisterColor(frame, {.u_begin = 50, .v_begin = 30, .u_end = 120, .v_end = 90},
                             &part);
  for (int v = 30; v < 90; ++v) {
    for (int u = 50; u < 120; ++u) {
      const auto at = static_cast<std::size_t>(v * camera.depth.width_px + u);
      ASSERT_EQ(part.color_known[at], whole.result.color_known[at]) << u << ", " << v;
      ASSERT_EQ(part.color.Pixel(u, v)[0], whole.Color(u, v)[0]);
    }
  }
  EXPECT_EQ(part.color_known[0], 0);
}

TEST(Registration, TakesRegisteredColorsAsTheyAre) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.color = camera.depth;
  camera.color_registered = true;
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  frame.color.Pixel(7, 9)[1] = 77;
  const Registered seen(camera, frame);
  ASSERT_TRUE(seen.status.ok());
  EXPECT_EQ(seen.result.color, frame.color);
  EXPECT_TRUE(seen.Known(7, 9));
}

TEST(Registration, GoesWithoutAColorCamera) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.color = {};
  rgbd::RgbdFrame frame = SquareBeforeObstacle(TwoCameras());
  frame.color = {};
  const Registered seen(camera, frame);
  ASSERT_TRUE(seen.status.ok()) << seen.status.message();
  EXPECT_FALSE(seen.Known(80, 60));
  EXPECT_FLOAT_EQ(*seen.result.z_m.Pixel(80, 60), 0.3f);
}

TEST(Registration, HonoursTheCamerasInvalidValue) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.invalid_value = kFar;
  const rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  const Registered seen(camera, frame);
  EXPECT_TRUE(std::isnan(*seen.result.z_m.Pixel(5, 5)));
  EXPECT_FLOAT_EQ(*seen.result.z_m.Pixel(80, 60), 0.3f);
}

TEST(Registration, HasNoDepthWhereTheLensCannotBeInverted) {
  rgbd::RgbdCamera camera = TwoCameras();
  camera.depth.fx_px = camera.depth.fy_px = 60.0;
  camera.depth.distortion[0] = -0.3;  // folds over at r = 1.05, before the corners
  const Registered seen(camera, SquareBeforeObstacle(camera));
  int blind = 0;
  for (int v = 0; v < camera.depth.height_px; ++v) {
    for (int u = 0; u < camera.depth.width_px; ++u) {
      const bool known = seen.registration.Ray(u, v).allFinite();
      EXPECT_NE(known, std::isnan(*seen.result.z_m.Pixel(u, v)));
      blind += known ? 0 : 1;
    }
  }
  EXPECT_GT(blind, 100);
}

TEST(Registration, RefusesImagesOfAnotherSize) {
  const rgbd::RgbdCamera camera = TwoCameras();
  rgbd::RgbdFrame frame = SquareBeforeObstacle(camera);
  frame.color = rgbd::ColorImage(160, 120);
  EXPECT_EQ(Registered(camera, frame).status.code(), StatusCode::kInvalidInput);
  frame = SquareBeforeObstacle(camera);
  frame.depth = {};
  const Registered seen(camera, frame);
  EXPECT_EQ(seen.status.code(), StatusCode::kInvalidInput);
  EXPECT_NE(seen.status.message().find("empty"), std::string::npos) << seen.status.message();
}

}  // namespace
}  // namespace palpate::perception
