// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/rigid_registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace palpate::geometry {
namespace {

const RigidTransform kMotion(Eigen::Quaterniond(0.4, -0.7, 0.2, 0.5),
                             Eigen::Vector3d(0.3, -1.2, 0.8));

Eigen::Matrix3Xd Cloud(int count) {
  std::mt19937 random(11);
  std::normal_distribution<double> value;
  return Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return 0.1 * value(random); });
}

TEST(RegisterRigid, FindsTheMotionOfExactPairs) {
  const Eigen::Matrix3Xd source = Cloud(20);
  const Registration found = RegisterRigid(source, kMotion.Apply(source));
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_LT(found.T_target_source.rotation().angularDistance(kMotion.rotation()), 1e-12);
  EXPECT_TRUE(found.T_target_source.translation_m().isApprox(kMotion.translation_m(), 1e-12));
  EXPECT_LT(found.rms_m, 1e-14);
}

TEST(RegisterRigid, ThreePointsAreEnough) {
  const Eigen::Matrix3Xd source = Cloud(3);
  const Registration found = RegisterRigid(source, kMotion.Apply(source));
  ASSERT_TRUE(found.status.ok()) << found.status.message();
  EXPECT_TRUE(found.T_target_source.Apply(source).isApprox(kMotion.Apply(source), 1e-12));
}

TEST(RegisterRigid, NeverReflects) {
  const Eigen::Matrix3Xd source = Cloud(20);
  Eigen::Matrix3Xd mirrored = source;
  mirrored.row(0) *= -1.0;
  const Registration found = RegisterRigid(source, mirrored);
  ASSERT_TRUE(found.status.ok());
  EXPECT_NEAR(found.T_target_source.rotation().toRotationMatrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(found.rms_m, 0.01);
}

TEST(RegisterRigid, PlanePointsAreTurnedAndNotFlipped) {
  Eigen::Matrix3Xd source = Cloud(12);
  source.row(2).setZero();
  const Registration found = RegisterRigid(source, kMotion.Apply(source));
  ASSERT_TRUE(found.status.ok());
  EXPECT_LT(found.T_target_source.rotation().angularDistance(kMotion.rotation()), 1e-11);
}

TEST(RegisterRigid, NoSmallTurnOrShiftIsBetter) {
  const Eigen::Matrix3Xd source = Cloud(20);
  std::mt19937 random(12);
  std::normal_distribution<double> noise(0.0, 0.005);
  const Eigen::Matrix3Xd target =
      kMotion.Apply(source) + Eigen::Matrix3Xd::NullaryExpr(3, 20, [&] { return noise(random); });
  const Registration found = RegisterRigid(source, target);
  ASSERT_TRUE(found.status.ok());
  const auto rms = [&](const RigidTransform& T) {
    return std::sqrt((target - T.Apply(source)).squaredNorm() / 20.0);
  };
  EXPECT_NEAR(found.rms_m, rms(found.T_target_source), 1e-15);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
      const RigidTransform turn(Eigen::Quaterniond(Eigen::AngleAxisd(step, direction)),
                                Eigen::Vector3d::Zero());
      const RigidTransform shift(Eigen::Quaterniond::Identity(), step * direction);
      EXPECT_GT(rms(found.T_target_source * turn), found.rms_m);
      EXPECT_GT(rms(shift * found.T_target_source), found.rms_m);
    }
  }
}

TEST(RegisterRigid, RefusesPointsOnOneLine) {
  Eigen::Matrix3Xd line = Eigen::Vector3d(1.0, 2.0, 3.0) * Eigen::RowVectorXd::LinSpaced(5, 0, 1);
  const Registration found = RegisterRigid(line, kMotion.Apply(line));
  EXPECT_EQ(found.status.code(), StatusCode::kUnobservable);
  EXPECT_NE(found.status.message().find("one line"), std::string::npos);
}

TEST(RegisterRigid, RefusesTooFewPoints) {
  EXPECT_EQ(RegisterRigid(Cloud(2), Cloud(2)).status.code(), StatusCode::kUnobservable);
  EXPECT_EQ(RegisterRigid(Cloud(0), Cloud(0)).status.code(), StatusCode::kUnobservable);
}

TEST(RegisterRigid, RefusesNanAndUnequalNumbers) {
  Eigen::Matrix3Xd source = Cloud(5);
  EXPECT_EQ(RegisterRigid(source, Cloud(6)).status.code(), StatusCode::kInvalidInput);
  source(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(RegisterRigid(source, Cloud(5)).status.code(), StatusCode::kInvalidInput);
}

}  // namespace
}  // namespace palpate::geometry
