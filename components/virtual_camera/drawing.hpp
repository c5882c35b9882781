// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "components/virtual_camera/kernels/color_rows.hpp"

namespace palpate::virtual_camera {

/// Two lamps far away and light from all around. Robot frame.
struct Lighting {
  double ambient = 0.0;
  Eigen::Matrix<double, 3, 2> to_lamp;  ///< unit
  Eigen::Vector2d intensity;

  /// Light on a surface with this unit normal.
  double On(const Eigen::Vector3d& normal) const;
};

/// A surface of triangles, robot frame.
struct DrawnMesh {
  Eigen::Matrix3Xd vertices_m;
  Eigen::Matrix3Xi triangles;  ///< anticlockwise from outside
  Eigen::Matrix3Xd texture_m;  ///< [3 x vertices] where the pattern is taken from
  Eigen::VectorXd light;       ///< [vertices]
  int paint = 0;
  bool closed = true;           ///< its inside is never seen
  std::vector<int> disc_list;   ///< discs on triangle t: disc_list[disc_begin[t] .. [t + 1])
  std::vector<int> disc_begin;  ///< empty: no discs
};

/// A sphere, a capsule or a cylinder; the axis is z of its frame.
struct DrawnRound {
  double radius_m = 0.0;
  double half_length_m = 0.0;
  bool round_ends = true;  ///< must be where half_length_m is 0
  Eigen::Isometry3d T_robot_shape = Eigen::Isometry3d::Identity();
  int paint = 0;
};

/// Everything that there is to see at one instant.
struct Drawing {
  std::vector<DrawnMesh> meshes;
  std::vector<DrawnRound> rounds;
  std::vector<kernels::Paint> paints;
  std::vector<kernels::Disc> discs;
  Lighting lighting;
};

/// A box with the full edges `size_m` along its axes, each face lit evenly. Its texture is its own
/// frame where `in_own_frame`, else the robot frame.
DrawnMesh MakeBox(const Eigen::Isometry3d& T_robot_box, const Eigen::Vector3d& size_m, int paint,
                  bool in_own_frame, const Lighting& lighting);

/// Lights each vertex by the mean of its triangles' normals, weighted by area.
void LightSmoothly(const Lighting& lighting, DrawnMesh* mesh);

}  // namespace palpate::virtual_camera
