// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::correspondence {

/// The robot's feature points X_e and the surface that they stand for. The surface is the drawn one
/// (four triangles for each face of tet10); each of its triangles belongs to the feature that is
/// nearest at rest, so that the features share the surface out among them. Near counts in place and
/// in direction: the back of a thin limb does not take part of its front.
class SurfaceFeatures {
 public:
  /// Throws InputError where the robot has no feature points.
  explicit SurfaceFeatures(const robot::RobotBody& body);

  int Count() const { return static_cast<int>(points_.size()); }
  const fem::InterpolationWeights& point(int feature) const { return points_[At(feature)]; }
  const Eigen::Matrix3Xd& rest_m() const { return rest_m_; }        ///< [3 x features]
  const Eigen::Matrix3Xi& triangles() const { return triangles_; }  ///< [3 x t] node numbers
  int FeatureOfTriangle(int triangle) const { return feature_of_triangle_[At(triangle)]; }

  /// Unit outward normals n_e of the features on the surface in its present shape [3 x features]:
  /// mean over the triangles at the feature, weighted by area and by how near it their common
  /// corner is. Zero where these have no area.
  Eigen::Matrix3Xd Normals(const Eigen::VectorXd& x_m) const;

 private:
  /// A triangle at a feature and its share in the normal.
  struct Part {
    int triangle;
    double weight;
  };

  void FindParts(const Eigen::Matrix3Xd& nodes_m);
  void ShareOut(const Eigen::Matrix3Xd& nodes_m);

  std::vector<fem::InterpolationWeights> points_;
  Eigen::Matrix3Xd rest_m_;
  Eigen::Matrix3Xi triangles_;
  std::vector<int> feature_of_triangle_;
  std::vector<std::vector<Part>> parts_of_feature_;
};

}  // namespace palpate::correspondence
