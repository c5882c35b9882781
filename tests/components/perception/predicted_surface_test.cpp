// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/predicted_surface.hpp"

#include <gtest/gtest.h>

namespace palpate::perception {
namespace {

TEST(PredictedSurface, StandsWhereTheCameraSeesTheRobot) {
  // The camera stands 1 m above the robot's origin and looks down: its z is the robot's -z.
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  T_robot_camera.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  Eigen::Matrix3Xf nodes_m(3, 2);
  nodes_m.col(0) << 0.1f, 0.2f, 0.25f;
  nodes_m.col(1) << 0.0f, 0.0f, 0.0f;
  const Eigen::Matrix3Xi triangles = Eigen::Vector3i(0, 1, 0);
  const PredictedSurface surface = MakePredictedSurface(nodes_m, triangles, T_robot_camera);
  ASSERT_EQ(surface.vertices_m.cols(), 2);
  EXPECT_TRUE(surface.vertices_m.col(0).isApprox(Eigen::Vector3d(0.1, -0.2, 0.75), 1e-6));
  EXPECT_TRUE(surface.vertices_m.col(1).isApprox(Eigen::Vector3d(0.0, 0.0, 1.0), 1e-6));
  EXPECT_EQ(surface.triangles, triangles);
}

}  // namespace
}  // namespace palpate::perception
