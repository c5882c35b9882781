// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::rgbd {
namespace {

CameraModel Straight() {
  return {.width_px = 848,
          .height_px = 480,
          .fx_px = 425.5,
          .fy_px = 430.25,
          .cx_px = 421.75,
          .cy_px = 238.5};
}

CameraModel WithDistortion(const Distortion& distortion) {
  CameraModel camera = Straight();
  camera.distortion = distortion;
  return camera;
}

/// Lenses as they are sold: barrel, pincushion, wavy (k1 and k2 of opposite signs), decentred, and
/// rational with a numerator and a denominator that nearly cancel, as calibrations find them.
const std::vector<Distortion> kLenses = {{},
                                         {-0.08},
                                         {0.15, -0.30, 1e-3, -2e-3, 0.11},
                                         {-0.055, 0.065, 4e-4, 8e-4, -0.021},
                                         {0.0, 0.0, 3e-3, -4e-3, 0.0},
                                         {6.3, 4.1, -3e-4, 2e-4, 0.2, 6.7, 6.2, 1.1}};

TEST(CameraModel, SeesAPointWhereThePinholeSaysByHand) {
  EXPECT_TRUE(Project(Straight(), {0.2, -0.1, 0.5})
                  .isApprox(Eigen::Vector2d(425.5 * 0.4 + 421.75, -430.25 * 0.2 + 238.5), 1e-15));
}

TEST(CameraModel, DistortsAsBrownAndConradyByHand) {
  const CameraModel camera = WithDistortion({0.1, -0.2, 0.003, -0.004, 0.05});
  const double x = 0.4, y = -0.2, s = x * x + y * y;
  const double radial = 1 + 0.1 * s - 0.2 * s * s + 0.05 * s * s * s;
  const double x_seen = x * radial + 2 * 0.003 * x * y - 0.004 * (s + 2 * x * x);
  const double y_seen = y * radial + 0.003 * (s + 2 * y * y) - 2 * 0.004 * x * y;
  const Eigen::Vector2d pixel = Project(camera, {0.2, -0.1, 0.5});
  EXPECT_NEAR(pixel.x(), 425.5 * x_seen + 421.75, 1e-11);
  EXPECT_NEAR(pixel.y(), 430.25 * y_seen + 238.5, 1e-11);
}

TEST(CameraModel, DistortsByTheRationalModelByHand) {
  const CameraModel camera = WithDistortion({0.1, -0.2, 0.003, -0.004, 0.05, 0.3, 0.02, -0.01});
  const double x = 0.4, y = -0.2, s = x * x + y * y;
  const double radial = (1 + 0.1 * s - 0.2 * s * s + 0.05 * s * s * s) /
                        (1 + 0.3 * s + 0.02 * s * s - 0.01 * s * s * s);
  const double x_seen = x * radial + 2 * 0.003 * x * y - 0.004 * (s + 2 * x * x);
  EXPECT_NEAR(Project(camera, {0.2, -0.1, 0.5}).x(), 425.5 * x_seen + 421.75, 1e-11);
}

TEST(CameraModel, UnprojectIsTheInverseOfProjectInEveryPixel) {
  for (const auto& lens : kLenses) {
    const CameraModel camera = WithDistortion(lens);
    for (int v = 0; v < camera.height_px; v += 13) {
      for (int u = 0; u < camera.width_px; u += 13) {
        const Eigen::Vector2d pixel(u, v);
        const Eigen::Vector3d direction = Unproject(camera, pixel);
        ASSERT_EQ(direction.z(), 1.0);
        ASSERT_LT((Project(camera, 0.7 * direction) - pixel).norm(), 425.5 * 1e-10)
            << lens[0] << " at " << u << ", " << v;
      }
    }
  }
}

TEST(CameraModel, ProjectIsTheInverseOfUnprojectForPointsInView) {
  std::mt19937 random(7);
  for (const auto& lens : kLenses) {
    const CameraModel camera = WithDistortion(lens);
    for (int i = 0; i < 200; ++i) {
      const auto share = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
      const Eigen::Vector3d direction(1.6 * share(), 0.9 * share(), 1.0);
      const Eigen::Vector3d found = Unproject(camera, Project(camera, 2.5 * direction));
      ASSERT_LT((found - direction).norm(), 1e-10);
    }
  }
}

TEST(CameraModel, SaysThatAPixelBeyondTheFoldOfTheLensSeesNothing) {
  // x' = x (1 - 0.4 x^2) has its largest value 0.6086 at x = 0.9129 and comes back from there.
  const CameraModel camera = WithDistortion({-0.4, 0.0, 0.0, 0.0, 0.0});
  const double fold = 2.0 / 3.0 / std::sqrt(3.0 * 0.4);
  const auto direction_at = [&](double x) {
    return Unproject(camera, {camera.cx_px + camera.fx_px * x, camera.cy_px});
  };
  EXPECT_NEAR(direction_at(fold - 1e-4).x(), 0.9129, 0.02);
  EXPECT_TRUE(std::isnan(direction_at(fold + 1e-4).x()));
  EXPECT_TRUE(std::isnan(direction_at(1.5).x()));
  EXPECT_TRUE(std::isnan(direction_at(1e3).x()));
}

TEST(CameraModel, TakesTheSolutionOnTheCentresSideOfAFold) {
  // Beyond the fold of k1 the k2 term turns the lens once more: a second solution lies far out.
  const CameraModel camera = WithDistortion({-0.5, 0.1, 0.0, 0.0, 0.0});
  for (double x = 0.1; x < 0.85; x += 0.05) {
    const Eigen::Vector3d found = Unproject(camera, Project(camera, {0.0, x, 1.0}));
    ASSERT_NEAR(found.y(), x, 1e-10);
  }
  EXPECT_TRUE(std::isnan(Unproject(camera, {camera.cx_px, camera.cy_px + 2.0 * 430.25}).y()));
}

TEST(CameraModel, SeesNoDistortionOnlyWhereEveryCoefficientIsZero) {
  EXPECT_FALSE(Straight().distorted());
  for (std::size_t i = 0; i < Distortion().size(); ++i) {
    Distortion one{};
    one[i] = 1e-3;
    EXPECT_TRUE(WithDistortion(one).distorted());
  }
}

}  // namespace
}  // namespace palpate::rgbd
