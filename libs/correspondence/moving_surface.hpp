// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "libs/core/index.hpp"

namespace palpate::correspondence {

/// Where the normal projection of a point meets a surface.
struct SurfaceFoot {
  int triangle = -1;                                      ///< -1: the surface has no area there
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< of its corners, each >= 0
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();       ///< unit, outward
  double height_m = 0.0;                                  ///< of the point, along `normal`
  double distance_m = 0.0;                                ///< >= |height_m|, more beyond a ridge
  /// The point lies beyond a sharp ridge: its side of the ridge is ambiguous.
  bool beyond_sharp_ridge = false;
};

/// The surface of a body as it is now, in the camera frame, with only the nodes that it uses.
class MovingSurface {
 public:
  explicit MovingSurface(const Eigen::Matrix3Xi& triangles);  ///< [3 x t] node numbers

  /// `x_m` [3n] nodes, robot frame.
  void MoveTo(const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_camera_robot);

  const Eigen::Matrix3Xd& vertices_m() const { return vertices_m_; }  ///< [3 x v] camera frame
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }    ///< [3 x t] vertex numbers
  int NodeOfVertex(int vertex) const { return nodes_[At(vertex)]; }   ///< rising

  /// Foot of `point_m` (camera frame), searched from triangle `start` on over the edges that the
  /// projection lies beyond. Beyond a ridge, where both triangles send it to the other, it is the
  /// ridge's nearest point and the normal is the mean of the two. None where triangles have no
  /// area.
  SurfaceFoot FootOf(const Eigen::Vector3d& point_m, int start) const;

 private:
  SurfaceFoot ClampTo(const Eigen::Vector3d& point_m, int triangle,
                      const Eigen::Vector3d& normal) const;

  std::vector<int> nodes_;
  Eigen::Matrix3Xi triangles_;
  Eigen::Matrix3Xi beyond_;  ///< [3 x t] triangle across the edge that faces a corner; -1: none
  Eigen::Matrix3Xd vertices_m_;
};

}  // namespace palpate::correspondence
