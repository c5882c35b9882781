// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/camera_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "components/virtual_camera/measured_points.hpp"

namespace palpate::diagnosis {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kViewStep = 1e-6;
const Eigen::Vector2d kFocal_px(420.0, 400.0);
const Eigen::Vector2d kUnknown_px =
    Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());

/// All at once, larger than any real camera's.
CameraErrors ManyErrors() {
  return {.depth_scale = 0.04,
          .incidence_bias_m = 0.006,
          .focal = -0.05,
          .cx_px = 12.0,
          .cy_px = -7.0,
          .k1 = 0.2,
          .drifts = {}};
}
constexpr double kDrift_m = 0.008;

const SeenPoint kAskew{{0.11, -0.06, 0.41}, Vector(0.5, 0.3, -0.9).normalized()};
/// Nearly, and wholly, seen from behind.
const SeenPoint kGrazing{{-0.09, 0.05, 0.38}, Vector(0.95, 0.3, 0.18).normalized()};
const SeenPoint kBehind{{0.02, 0.03, 0.5}, Vector(0.1, 0.2, 0.9).normalized()};

Vector Measured(const CameraErrors& errors, const SeenPoint& point) {
  return CameraView(errors, kFocal_px, kDrift_m).Measured(point);
}

TEST(CameraView, WithoutErrorsMeasuresPointsWhereTheyAre) {
  const CameraView view({}, kUnknown_px, 0.0);
  EXPECT_LT((view.Measured(kAskew) - kAskew.at_m).norm(), 1e-15);
  EXPECT_LT((view.Slope(kAskew) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(CameraView, AnErrorOfDepthActsAlongTheRay) {
  const Vector scaled = CameraView({.depth_scale = -0.019}, kUnknown_px, 0.0).Measured(kAskew);
  EXPECT_LT((scaled - 0.981 * kAskew.at_m).norm(), 1e-15);
  const Vector drifted = CameraView({}, kUnknown_px, 0.004).Measured(kAskew);
  EXPECT_NEAR(drifted.z(), kAskew.at_m.z() + 0.004, 1e-15);
  EXPECT_LT(drifted.cross(kAskew.at_m).norm(), 1e-15);
  const Vector askew = CameraView({.incidence_bias_m = 0.003}, kUnknown_px, 0.0).Measured(kAskew);
  const double cosine = -kAskew.normal.dot(kAskew.at_m.normalized());
  EXPECT_NEAR((askew - kAskew.at_m).norm(), 0.003 * (1.0 / cosine - 1.0), 1e-15);
  EXPECT_LT(askew.cross(kAskew.at_m).norm(), 1e-15);
}

/// Else the error of b would be told by the marker that is seen most askew, or from behind.
TEST(CameraView, AnErrorByIncidenceGrowsUpTo75DegreesOnly) {
  for (const SeenPoint& point : {kGrazing, kBehind}) {
    const Vector measured =
        CameraView({.incidence_bias_m = 0.003}, kUnknown_px, 0.0).Measured(point);
    EXPECT_NEAR((measured - point.at_m).norm(), 0.003 * (1.0 / 0.25 - 1.0), 1e-15);
  }
}

TEST(CameraView, AnErrorOfTheLensLeavesDepthAsItIs) {
  // Seen at u = 420 (1 + 0.02) 0.11 / 0.41 + 3 from the assumed centre.
  const CameraView view({.focal = 0.02, .cx_px = 3.0, .cy_px = -5.0}, kFocal_px, 0.0);
  const Vector measured = view.Measured(kAskew);
  EXPECT_DOUBLE_EQ(measured.z(), 0.41);
  EXPECT_NEAR(measured.x(), 1.02 * 0.11 + 3.0 / 420.0 * 0.41, 1e-15);
  EXPECT_NEAR(measured.y(), 1.02 * -0.06 - 5.0 / 400.0 * 0.41, 1e-15);
  const Vector bent = CameraView({.k1 = -0.1}, kFocal_px, 0.0).Measured(kAskew);
  const double r_squared = (0.11 * 0.11 + 0.06 * 0.06) / (0.41 * 0.41);
  EXPECT_DOUBLE_EQ(bent.z(), 0.41);
  EXPECT_NEAR(bent.x(), 0.11 * (1.0 - 0.1 * r_squared), 1e-15);
}

TEST(CameraView, SlopeIsThatOfMeasured) {
  for (const SeenPoint& point : {kAskew, kGrazing, kBehind}) {
    const Eigen::Matrix3d slope = CameraView(ManyErrors(), kFocal_px, kDrift_m).Slope(point);
    for (int axis = 0; axis < 3; ++axis) {
      SeenPoint plus = point;
      SeenPoint minus = point;
      plus.at_m[axis] += kViewStep;
      minus.at_m[axis] -= kViewStep;
      const Vector difference =
          (Measured(ManyErrors(), plus) - Measured(ManyErrors(), minus)) / (2.0 * kViewStep);
      EXPECT_LT((slope.col(axis) - difference).norm(), 1e-7) << axis;
    }
  }
}

TEST(CameraView, DerivativesByErrorsAreThoseOfMeasured) {
  const auto difference = [](const SeenPoint& point, double CameraErrors::*error) {
    CameraErrors plus = ManyErrors();
    CameraErrors minus = ManyErrors();
    plus.*error += kViewStep;
    minus.*error -= kViewStep;
    return Vector((Measured(plus, point) - Measured(minus, point)) / (2.0 * kViewStep));
  };
  const CameraView view(ManyErrors(), kFocal_px, kDrift_m);
  for (const SeenPoint& p : {kAskew, kGrazing, kBehind}) {
    const auto expect = [&](const Vector& analytic, double CameraErrors::*error) {
      EXPECT_LT((analytic - difference(p, error)).norm(), 1e-8);
      EXPECT_GT(analytic.norm(), 1e-5);
    };
    expect(view.ByDepthScale(p), &CameraErrors::depth_scale);
    expect(view.ByIncidence(p), &CameraErrors::incidence_bias_m);
    expect(view.ByFocal(p), &CameraErrors::focal);
    expect(view.ByCentre(p, 0), &CameraErrors::cx_px);
    expect(view.ByCentre(p, 1), &CameraErrors::cy_px);
    expect(view.ByDistortion(p), &CameraErrors::k1);
    const Vector by_drift =
        (CameraView(ManyErrors(), kFocal_px, kDrift_m + kViewStep).Measured(p) -
         CameraView(ManyErrors(), kFocal_px, kDrift_m - kViewStep).Measured(p)) /
        (2.0 * kViewStep);
    EXPECT_LT((view.ByDrift(p) - by_drift).norm(), 1e-8);
  }
}

TEST(CameraView, LeavesWhatIsNotBeforeTheCameraAlone) {
  const SeenPoint point{{0.1, 0.2, -0.3}, Vector::UnitZ()};
  const CameraView view(ManyErrors(), kFocal_px, kDrift_m);
  EXPECT_EQ(view.Measured(point), point.at_m);
  EXPECT_EQ(view.Slope(point), Eigen::Matrix3d::Identity());
  EXPECT_TRUE(view.ByFocal(point).isZero(0.0) && view.ByDepthScale(point).isZero(0.0));
}

TEST(CameraView, MeansTheSameErrorsAsTheVirtualCamera) {
  const CameraErrors errors = ManyErrors();
  const virtual_camera::CameraFaults faults{.moves = {},
                                            .depth_scale = errors.depth_scale,
                                            .incidence_bias_m = errors.incidence_bias_m,
                                            .flying_pixel_ratio = 0.0,
                                            .focal = errors.focal,
                                            .cx_px = errors.cx_px,
                                            .cy_px = errors.cy_px,
                                            .k1 = errors.k1,
                                            .drifts = {{0.01, 30.0}}};
  const rgbd::CameraModel data_sheet{.width_px = 640,
                                     .height_px = 480,
                                     .fx_px = kFocal_px.x(),
                                     .fy_px = kFocal_px.y(),
                                     .cx_px = 320.0,
                                     .cy_px = 240.0};
  constexpr double kTime_s = 50.0;
  const CameraView view(errors, kFocal_px, 0.01 * (1.0 - std::exp(-kTime_s / 30.0)));
  for (const SeenPoint& point : {kAskew, kGrazing, kBehind}) {
    const Vector wanted =
        virtual_camera::MeasurePoints(faults, data_sheet, kTime_s, point.at_m, point.normal);
    EXPECT_LT((view.Measured(point) - wanted).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace palpate::diagnosis
