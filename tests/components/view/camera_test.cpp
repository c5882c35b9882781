// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::view {
namespace {

std::vector<Extent> SomeExtents() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.2, 0.3);
  std::vector<Extent> extents;
  for (int i = 0; i < 200; ++i) {
    extents.push_back({{place(random), 0.1 * place(random), place(random)}, 0.004 * (i % 3)});
  }
  return extents;
}

class CameraFit : public testing::TestWithParam<double> {};

TEST_P(CameraFit, ShowsEverythingAndTouchesTheArea) {
  const Rect area{40, 60, 700, 500};
  const auto extents = SomeExtents();
  const Camera camera = Camera::Fit({-50.0, 25.0, GetParam()}, extents, area);
  double least_gap_px = 1e9;
  for (const Extent& extent : extents) {
    const Eigen::Vector3d seen = camera.Project(extent.center_m);
    const double radius_px =
        extent.radius_m * (camera.Project(extent.center_m + camera.right()) - seen).x();
    for (const double gap :
         {seen.x() - radius_px - area.x_px, area.right_px() - seen.x() - radius_px,
          seen.y() - radius_px - area.y_px, area.bottom_px() - seen.y() - radius_px}) {
      EXPECT_GE(gap, -1e-6);
      least_gap_px = std::min(least_gap_px, gap);
    }
  }
  EXPECT_LT(least_gap_px, 5.0);
}

INSTANTIATE_TEST_SUITE_P(Projections, CameraFit, testing::Values(0.0, 3.0));

TEST(Camera, MeasuresLengthsWhenOrthographic) {
  const Camera camera = Camera::Fit({}, SomeExtents(), {0, 0, 640, 480});
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 0.2, -0.1)}) {
    const Eigen::Vector3d step = camera.Project(at + 0.01 * camera.right()) - camera.Project(at);
    EXPECT_NEAR(step.x(), 0.01 * camera.px_per_m(), 1e-9);
    EXPECT_NEAR(step.y(), 0.0, 1e-9);
  }
}

TEST(Camera, CallsNearerWhatIsCloserToTheViewer) {
  for (const double eye : {0.0, 3.0}) {
    const Camera camera = Camera::Fit({30.0, 10.0, eye}, SomeExtents(), {0, 0, 640, 480});
    const Eigen::Vector3d at(0.02, 0.01, 0.0);
    const Eigen::Vector3d closer = at + 0.01 * camera.TowardViewer(at);
    EXPECT_GT(camera.Project(closer).z(), camera.Project(at).z());
    EXPECT_NEAR((camera.Project(closer) - camera.Project(at)).head<2>().norm(), 0.0, 1e-9);
  }
}

TEST(Camera, KeepsUpUp) {
  const Camera camera = Camera::Fit({123.0, 40.0}, SomeExtents(), {0, 0, 640, 480});
  EXPECT_LT(camera.Project({0, 0, 0.1}).y(), camera.Project({0, 0, 0}).y());
  EXPECT_NEAR(camera.Project({0, 0, 0.1}).x(), camera.Project({0, 0, 0}).x(), 1e-9);
}

}  // namespace
}  // namespace palpate::view
