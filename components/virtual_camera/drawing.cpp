// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::virtual_camera {

double Lighting::On(const Eigen::Vector3d& normal) const {
  return ambient + intensity[0] * std::max(0.0, normal.dot(to_lamp.col(0))) +
         intensity[1] * std::max(0.0, normal.dot(to_lamp.col(1)));
}

DrawnMesh MakeBox(const Eigen::Isometry3d& T_robot_box, const Eigen::Vector3d& size_m, int paint,
                  bool in_own_frame, const Lighting& lighting) {
  DrawnMesh box;
  box.paint = paint;
  box.vertices_m.resize(3, 24);
  box.texture_m.resize(3, 24);
  box.triangles.resize(3, 12);
  box.light.resize(24);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 == 0 ? -1.0 : 1.0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    normal[axis] = side;
    Eigen::Vector3d across = Eigen::Vector3d::Zero();
    across[(axis + 1) % 3] = 1.0;
    const Eigen::Vector3d up = normal.cross(across);
    const int first = 4 * face;
    for (int corner = 0; corner < 4; ++corner) {
      const double a = corner == 1 || corner == 2 ? 1.0 : -1.0;
      const double b = corner >= 2 ? 1.0 : -1.0;
      const Eigen::Vector3d own = 0.5 * size_m.cwiseProduct(normal + a * across + b * up);
      box.vertices_m.col(first + corner) = T_robot_box * own;
      box.texture_m.col(first + corner) = in_own_frame ? own : Eigen::Vector3d(T_robot_box * own);
    }
    box.light.segment<4>(first).setConstant(lighting.On(T_robot_box.linear() * normal));
    box.triangles.col(2 * face) << first, first + 1, first + 2;
    box.triangles.col(2 * face + 1) << first, first + 2, first + 3;
  }
  return box;
}

void LightSmoothly(const Lighting& lighting, DrawnMesh* mesh) {
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, mesh->vertices_m.cols());
  for (Eigen::Index t = 0; t < mesh->triangles.cols(); ++t) {
    const Eigen::Vector3i corners = mesh->triangles.col(t);
    const Eigen::Vector3d origin = mesh->vertices_m.col(corners[0]);
    const Eigen::Vector3d area = (mesh->vertices_m.col(corners[1]) - origin)
                                     .cross(mesh->vertices_m.col(corners[2]) - origin);
    for (const int corner : corners) normals.col(corner) += area;
  }
  mesh->light.resize(normals.cols());
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    const double length = normals.col(i).norm();
    const Eigen::Vector3d normal = normals.col(i) / (length > 0.0 ? length : 1.0);
    mesh->light[i] = lighting.On(normal);
  }
}

}  // namespace palpate::virtual_camera
