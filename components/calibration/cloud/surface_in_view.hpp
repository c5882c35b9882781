// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/rgbd/surface_view.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {

/// Nearest visible surface point of a cloud point.
struct SurfaceFoot {
  int triangle = -1;  ///< of the surface triangles
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< robot frame
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();      ///< unit, outward, robot frame
  double distance_m = 0.0;                               ///< >= 0
  double openness = 0.0;  ///< weight by angle of view: 0 grazing, up to 1
};

/// Visible part of a robot's surface in one shape: triangles that face the camera and are not
/// hidden, by a z-buffer from the camera's centre. Lens and image size do not matter. A face of
/// tet10 is four triangles.
class SurfaceInView {
 public:
  explicit SurfaceInView(const robot::RobotBody& body);

  /// `x_m` [3n] nodes, robot frame.
  void TakeShape(const Eigen::VectorXd& x_m);
  /// Computes visibility from the camera's centre. Needs TakeShape before it.
  void LookFrom(const geometry::RigidTransform& T_robot_camera);

  /// Number of visible triangles.
  int SeenCount() const { return static_cast<int>(seen_.size()); }
  /// The nearest visible surface point of a point in the robot frame. nullopt: nothing is visible,
  /// or that surface point is hidden or at a grazing angle.
  std::optional<SurfaceFoot> FootOf(const Eigen::Vector3d& point_robot_m) const;
  fem::InterpolationWeights WeightsOf(const SurfaceFoot& foot) const;
  /// Distance of the smooth surface from this triangle, m: largest arc height over an edge, edge *
  /// angle between the vertex normals / 8.
  double FacetError_m(int triangle) const { return facet_error_m_[triangle]; }
  /// [3 x n] surface points at the centres of the z-buffer's pixels, robot frame.
  const Eigen::Matrix3Xd& seen_places_m() const { return seen_places_m_; }
  /// Unit, outward, robot frame.
  Eigen::Vector3d NormalAtSeenPlace(Eigen::Index place) const {
    return normals_.col(triangle_of_place_[At(place)]);
  }

 private:
  bool Aim();
  void CollectSeen();
  bool IsHidden(const Eigen::Vector3d& place_robot_m) const;

  std::vector<int> nodes_;             ///< [vertices] of the mesh, ascending
  geometry::TriangleSurface surface_;  ///< robot frame, of the vertices
  Eigen::Matrix3Xd normals_;           ///< [3 x triangles]
  Eigen::VectorXd facet_error_m_;      ///< [triangles]
  Eigen::Vector3d eye_m_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  ///< robot axes to those of the view
  double focal_px_ = 1.0;
  rgbd::SurfaceView view_;
  Eigen::Matrix3Xd aimed_m_;  ///< [3 x vertices] view frame, x and y times the focal length
  std::vector<int> seen_;     ///< triangles of `seen_index_`
  std::unique_ptr<geometry::SurfaceIndex> seen_index_;
  Eigen::Matrix3Xd seen_places_m_;
  std::vector<int> triangle_of_place_;
};

}  // namespace palpate::calibration
