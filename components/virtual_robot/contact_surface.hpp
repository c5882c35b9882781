// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::virtual_robot {

/// The body's surface as points on its faces, each with its share of the area at rest: where
/// contact is searched and acts. Faces whose nodes are all clamped are left out.
class ContactSurface {
 public:
  ContactSurface(const fem::TetMesh& mesh, const fem::BoundarySurface& boundary,
                 const Eigen::Matrix<bool, 3, Eigen::Dynamic>& fixed);

  int FaceCount() const { return static_cast<int>(faces_.cols()); }
  int PointsPerFace() const { return static_cast<int>(shape_.cols()); }
  int PointCount() const { return FaceCount() * PointsPerFace(); }
  const Eigen::MatrixXi& faces() const { return faces_; }  ///< [3 or 6 x faces] nodes
  /// [3 or 6] shape functions of the face's nodes at its k-th point.
  auto Shape(int k) const { return shape_.col(k); }
  double Area_m2(int face, int k) const { return area_m2_(k, face); }
  double TotalArea_m2() const { return area_m2_.sum(); }

  Eigen::Vector3d Position_m(int face, int k, const Eigen::VectorXd& x_m) const;
  /// Whether the face may come within `radius_m` of `centre_m`: by the box about its nodes.
  bool MayTouch(int face, const Eigen::VectorXd& x_m, const Eigen::Vector3d& centre_m,
                double radius_m) const;

 private:
  Eigen::MatrixXi faces_;
  Eigen::MatrixXd shape_;    ///< [3 or 6 x points]
  Eigen::MatrixXd area_m2_;  ///< [points x faces]
};

}  // namespace palpate::virtual_robot
