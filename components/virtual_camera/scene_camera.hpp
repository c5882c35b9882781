// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "components/virtual_camera/drawing.hpp"
#include "components/virtual_camera/z_buffer.hpp"

namespace palpate::virtual_camera {

/// Nearer than this nothing is seen; surfaces that reach farther are cut there.
inline constexpr double kNearest_m = 0.01;

/// One camera in front of a scene: which surface each pixel sees, and its appearance.
/// Triangles and round shapes are both met exactly at the centre of each pixel; round shapes are
/// not cut into triangles.
class SceneCamera {
 public:
  SceneCamera(const rgbd::CameraModel& camera, const kernels::Kernels& loops);

  /// Buffers are used again from one drawing to the next. `drawing` must live as long as palette()
  /// is used.
  void Look(const Drawing& drawing, const Eigen::Isometry3d& T_robot_camera);

  const rgbd::CameraModel& camera() const { return z_buffer_.camera(); }
  ZBuffer& z_buffer() { return z_buffer_; }
  const kernels::Palette& palette() const { return palette_; }

 private:
  void AddMesh(const DrawnMesh& mesh, const Eigen::Isometry3d& T_camera_robot);
  void AddFacet(const DrawnMesh& mesh, Eigen::Index triangle);
  void AddFlatTriangles(const Eigen::Vector3i& corners, const Eigen::Vector3d& inverse_z);
  void AddFlatTriangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                       const Eigen::Vector3d& inverse_z);
  void AddRound(const DrawnRound& shape, const Eigen::Isometry3d& T_camera_robot);
  bool IsInView(const Eigen::Vector3i& corners) const;

  ZBuffer z_buffer_;
  Eigen::Matrix3Xd seen_m_;     // of the mesh in work: vertices in the camera's frame
  Eigen::Matrix2Xd on_canvas_;  // and where they are seen, where z >= kNearest_m
  std::vector<kernels::FlatTriangle> flat_;
  std::vector<kernels::Facet> facets_;
  std::vector<kernels::RoundLook> rounds_;
  std::vector<kernels::RoundSurface> round_surfaces_;
  std::vector<Eigen::Array<double, 2, 2>> round_bounds_;  // columns: min, max
  std::vector<int> disc_list_;
  kernels::Palette palette_ = {};
};

}  // namespace palpate::virtual_camera
