// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/surface_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace palpate::rgbd {
namespace {

CameraModel SmallCamera() {
  return {.width_px = 64,
          .height_px = 48,
          .fx_px = 50.0,
          .fy_px = 55.0,
          .cx_px = 31.25,
          .cy_px = 23.75};
}

/// Ten points in a box before the camera, some of them out of sight to the sides.
Eigen::Matrix3Xd RandomVertices(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> across(-0.5, 0.5);
  std::uniform_real_distribution<double> along(0.4, 0.8);
  Eigen::Matrix3Xd vertices_m(3, count);
  for (auto vertex : vertices_m.colwise()) {
    vertex.x() = across(random);
    vertex.y() = across(random);
    vertex.z() = along(random);
  }
  return vertices_m;
}

/// Where the line of sight of a pixel meets a triangle: z, or 0; NaN nearly on an edge.
double MeetingZ_m(const CameraModel& camera, int u_px, int v_px, const Eigen::Matrix3d& corners_m) {
  const Eigen::Vector3d direction = Unproject(camera, {u_px, v_px});
  const Eigen::Vector3d shares = corners_m.inverse() * direction;  // of the corners, times 1 / z
  const double z_m = 1.0 / shares.sum();
  if ((z_m * shares).minCoeff() < -1e-6) return 0.0;
  return (z_m * shares).minCoeff() > 1e-6 ? z_m : std::nan("");
}

int DrawnPixels(const SurfaceView& view) {
  int drawn = 0;
  for (int v = 0; v < view.camera().height_px; ++v) {
    for (int u = 0; u < view.camera().width_px; ++u) {
      if (view.Triangle(u, v) != SurfaceView::kNothing) ++drawn;
    }
  }
  return drawn;
}

TEST(SurfaceView, SeesNothingBeforeItLooks) {
  const SurfaceView view(SmallCamera());
  EXPECT_EQ(DrawnPixels(view), 0);
  EXPECT_TRUE(view.bounds().empty());
  EXPECT_EQ(view.Z_m(3, 4), 0.0f);
}

/// Of triangles that stand any way, also out of the picture, each pixel shows the nearest that its
/// line of sight meets, at the depth where it meets it.
TEST(SurfaceView, ShowsTheNearestTriangleOnEachLineOfSight) {
  const CameraModel camera = SmallCamera();
  SurfaceView view(camera);
  std::mt19937 random(21);
  int seen = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const Eigen::Matrix3Xd vertices_m = RandomVertices(random, 12);
    Eigen::Matrix3Xi triangles(3, 4);
    triangles << 0, 3, 6, 9, 1, 4, 7, 10, 2, 5, 8, 11;
    view.Look(vertices_m, triangles);
    for (int v = 0; v < camera.height_px; ++v) {
      for (int u = 0; u < camera.width_px; ++u) {
        double nearest_m = std::numeric_limits<double>::infinity();
        int expected = SurfaceView::kNothing;
        bool on_edge = false;
        for (int t = 0; t < 4; ++t) {
          const double z_m = MeetingZ_m(camera, u, v, vertices_m.middleCols(3 * t, 3));
          on_edge = on_edge || std::isnan(z_m);
          if (!(z_m > 0.0) || z_m >= nearest_m) continue;
          nearest_m = z_m;
          expected = t;
        }
        if (on_edge) continue;
        ASSERT_EQ(view.Triangle(u, v), expected) << u << ' ' << v;
        if (expected == SurfaceView::kNothing) {
          ASSERT_EQ(view.Z_m(u, v), 0.0f);
          continue;
        }
        ASSERT_NEAR(static_cast<double>(view.Z_m(u, v)), nearest_m, 1e-6);
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 2000);
}

TEST(SurfaceView, BothSidesOfATriangleHideWhatIsBehind) {
  SurfaceView view(SmallCamera());
  Eigen::Matrix3Xd vertices_m(3, 6);
  vertices_m << -0.2, 0.2, 0.0, -0.2, 0.2, 0.0,  //
      -0.2, -0.2, 0.2, -0.2, -0.2, 0.2,          //
      0.6, 0.6, 0.6, 0.5, 0.5, 0.5;
  Eigen::Matrix3Xi triangles(3, 2);
  for (const bool turned : {false, true}) {
    for (const int near : {0, 1}) {
      triangles.col(1 - near) << 0, 1, 2;
      triangles.col(near) << 3, turned ? 5 : 4, turned ? 4 : 5;
      view.Look(vertices_m, triangles);
      EXPECT_EQ(view.Triangle(31, 22), near);
      EXPECT_NEAR(static_cast<double>(view.Z_m(31, 22)), 0.5, 1e-6);
    }
  }
}

TEST(SurfaceView, ForgetsWhatItSawBefore) {
  std::mt19937 random(4);
  Eigen::Matrix3Xi triangles(3, 4);
  triangles << 0, 3, 6, 9, 1, 4, 7, 10, 2, 5, 8, 11;
  SurfaceView used(SmallCamera());
  for (int k = 0; k < 5; ++k) {
    const Eigen::Matrix3Xd vertices_m = 0.5 * RandomVertices(random, 12);
    used.Look(vertices_m, triangles);
    SurfaceView fresh(SmallCamera());
    fresh.Look(vertices_m, triangles);
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        ASSERT_EQ(used.Triangle(u, v), fresh.Triangle(u, v));
        ASSERT_EQ(used.Z_m(u, v), fresh.Z_m(u, v));
      }
    }
  }
  used.Look(Eigen::Matrix3Xd::Zero(3, 0), Eigen::Matrix3Xi::Zero(3, 0));
  EXPECT_EQ(DrawnPixels(used), 0);
  EXPECT_TRUE(used.bounds().empty());
}

TEST(SurfaceView, BoundsHoldAllThatWasDrawnAndLieInThePicture) {
  std::mt19937 random(9);
  Eigen::Matrix3Xi triangle(3, 1);
  triangle << 0, 1, 2;
  SurfaceView view(SmallCamera());
  for (int k = 0; k < 50; ++k) {
    view.Look(RandomVertices(random, 3), triangle);
    const SurfaceView::Bounds& bounds = view.bounds();
    EXPECT_GE(bounds.u_begin, 0);
    EXPECT_GE(bounds.v_begin, 0);
    EXPECT_LE(bounds.u_end, 64);
    EXPECT_LE(bounds.v_end, 48);
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        if (view.Triangle(u, v) == SurfaceView::kNothing) continue;
        ASSERT_TRUE(u >= bounds.u_begin && u < bounds.u_end);
        ASSERT_TRUE(v >= bounds.v_begin && v < bounds.v_end);
      }
    }
  }
}

/// A square that fills whole pixels, cut along lines through pixel centres: no centre falls between
/// the parts.
TEST(SurfaceView, LeavesNoGapWhereTrianglesMeetOnPixelCentres) {
  const CameraModel camera{
      .width_px = 32, .height_px = 32, .fx_px = 30.0, .fy_px = 30.0, .cx_px = 15.0, .cy_px = 15.0};
  SurfaceView view(camera);
  Eigen::Matrix3Xd vertices_m(3, 5);
  vertices_m << 0.0, -0.1, 0.1, 0.1, -0.1,  //
      0.0, -0.1, -0.1, 0.1, 0.1,            //
      0.3, 0.3, 0.3, 0.3, 0.3;
  Eigen::Matrix3Xi triangles(3, 4);
  triangles << 0, 0, 0, 0, 1, 2, 3, 4, 2, 3, 4, 1;
  view.Look(vertices_m, triangles);
  for (int v = 6; v <= 24; ++v) {
    for (int u = 6; u <= 24; ++u) EXPECT_NE(view.Triangle(u, v), SurfaceView::kNothing);
  }
  EXPECT_LE(DrawnPixels(view), 21 * 21);
  EXPECT_GE(DrawnPixels(view), 19 * 19);
}

TEST(SurfaceView, LeavesOutWhatReachesBehindTheCamera) {
  SurfaceView view(SmallCamera());
  Eigen::Matrix3Xi triangle(3, 1);
  triangle << 0, 1, 2;
  Eigen::Matrix3Xd vertices_m(3, 3);
  vertices_m << -0.1, 0.1, 0.0, -0.1, -0.1, 0.1, 0.5, 0.5, 0.5;
  for (const double z_m : {-0.5, 0.0, 0.5 * SurfaceView::kNearest_m}) {
    vertices_m(2, 2) = z_m;
    view.Look(vertices_m, triangle);
    EXPECT_EQ(DrawnPixels(view), 0) << z_m;
  }
  vertices_m(2, 2) = SurfaceView::kNearest_m;
  view.Look(vertices_m, triangle);
  EXPECT_GT(DrawnPixels(view), 0);
}

/// Corners lie where the lens shows them.
TEST(SurfaceView, SeesThroughADistortedLens) {
  CameraModel camera = SmallCamera();
  camera.distortion = {-0.2, 0.05, 1e-3, -1e-3, 0.0};
  SurfaceView view(camera);
  Eigen::Matrix3Xi triangle(3, 1);
  triangle << 0, 1, 2;
  for (const Eigen::Vector2d& corner_px :
       {Eigen::Vector2d(5.0, 5.0), Eigen::Vector2d(58.0, 6.0), Eigen::Vector2d(30.0, 44.0)}) {
    Eigen::Matrix3Xd vertices_m(3, 3);  // one pixel in each direction around the corner
    vertices_m << 0.5 * Unproject(camera, corner_px + Eigen::Vector2d(-0.9, -0.9)),
        0.5 * Unproject(camera, corner_px + Eigen::Vector2d(0.9, -0.9)),
        0.5 * Unproject(camera, corner_px + Eigen::Vector2d(0.0, 0.9));
    view.Look(vertices_m, triangle);
    EXPECT_EQ(DrawnPixels(view), 1);
    EXPECT_EQ(view.Triangle(static_cast<int>(corner_px.x()), static_cast<int>(corner_px.y())), 0);
  }
}

}  // namespace
}  // namespace palpate::rgbd
