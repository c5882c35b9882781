// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/rigid_transform.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "libs/geometry/box.hpp"

namespace palpate::geometry {
namespace {

RigidTransform RandomTransform(std::mt19937* random) {
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  const auto next = [&] { return value(*random); };
  const Eigen::Quaterniond rotation(next(), next(), next(), next());
  return {rotation, Eigen::Vector3d(next(), next(), next())};
}

TEST(RigidTransform, ComposesAsItsNamesCancel) {
  std::mt19937 random(1);
  const RigidTransform T_a_b = RandomTransform(&random);
  const RigidTransform T_b_c = RandomTransform(&random);
  const Eigen::Vector3d p_c(0.3, -0.2, 0.9);
  EXPECT_TRUE(((T_a_b * T_b_c) * p_c).isApprox(T_a_b * (T_b_c * p_c), 1e-14));
}

TEST(RigidTransform, InverseUndoesIt) {
  std::mt19937 random(2);
  const RigidTransform T_a_b = RandomTransform(&random);
  const Eigen::Vector3d p_b(0.3, -0.2, 0.9);
  EXPECT_TRUE((T_a_b.Inverse() * (T_a_b * p_b)).isApprox(p_b, 1e-14));
  EXPECT_TRUE((T_a_b * T_a_b.Inverse()).rotation().isApprox(Eigen::Quaterniond::Identity(), 1e-14));
}

TEST(RigidTransform, AppliesToPointSetsAsToSinglePoints) {
  std::mt19937 random(3);
  const RigidTransform T_a_b = RandomTransform(&random);
  const Eigen::Matrix3Xd points_b = Eigen::Matrix3Xd::Random(3, 7);
  const Eigen::Matrix3Xd points_a = T_a_b.Apply(points_b);
  for (Eigen::Index k = 0; k < 7; ++k) {
    EXPECT_TRUE(points_a.col(k).isApprox(T_a_b * Eigen::Vector3d(points_b.col(k)), 1e-14));
  }
}

TEST(RigidTransform, TurnsVectorsWithoutMovingThem) {
  const Eigen::Quaterniond quarter_turn(
      Eigen::AngleAxisd(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()));
  const RigidTransform T_a_b(quarter_turn, Eigen::Vector3d(5.0, 6.0, 7.0));
  EXPECT_TRUE(T_a_b.Rotate(Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-14));
  EXPECT_TRUE((T_a_b * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(5.0, 7.0, 7.0), 1e-14));
}

TEST(RigidTransform, NormalisesItsQuaternion) {
  const RigidTransform T_a_b(Eigen::Quaterniond(2.0, 0.0, 0.0, 2.0), Eigen::Vector3d::Zero());
  EXPECT_NEAR(T_a_b.rotation().norm(), 1.0, 1e-15);
}

TEST(RotationFromFixedXyz, TurnsAboutFixedAxesInTheOrderXThenYThenZ) {
  const Eigen::Vector3d angles_deg(20.0, -35.0, 50.0);
  const Eigen::Vector3d angles = angles_deg * std::numbers::pi / 180.0;
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  EXPECT_TRUE(RotationFromFixedXyz_deg(angles_deg).isApprox(expected, 1e-14));
}

TEST(RotationFromFixedXyz, IsExactAtRightAngles) {
  Eigen::Matrix3d expected;
  expected << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_EQ(RotationFromFixedXyz_deg({90.0, 0.0, 0.0}), expected);
  EXPECT_EQ(RotationFromFixedXyz_deg({-270.0, 0.0, 360.0}), expected);
  EXPECT_EQ(RotationFromFixedXyz_deg({180.0, 180.0, 180.0}), Eigen::Matrix3d::Identity());
}

TEST(Box, HoldsItsOwnBoundsAndMeasuresTheDistanceToItself) {
  const Box box = BoundingBox((Eigen::Matrix3Xd(3, 2) << 0, 1, 0, 2, 0, 3).finished());
  EXPECT_TRUE(box.Contains({1.0, 2.0, 3.0}));
  EXPECT_FALSE(box.Contains({1.0, 2.0, 3.0 + 1e-12}));
  EXPECT_DOUBLE_EQ(box.Diagonal_m(), std::sqrt(14.0));
  EXPECT_EQ(box.SquaredDistance_m2({0.5, 0.5, 0.5}), 0.0);
  EXPECT_DOUBLE_EQ(box.SquaredDistance_m2({2.0, 4.0, 3.0}), 5.0);
}

}  // namespace
}  // namespace palpate::geometry
