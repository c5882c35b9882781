// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <string>

#include "components/virtual_camera/drawing.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/image.hpp"

namespace palpate::virtual_camera {

/// A drawing as Embree sees it from one place: triangles as they are, spheres and capsules as
/// Embree's own, cylinders as fine prisms (to 0.1 um).
class EmbreeOracle {
 public:
  EmbreeOracle(const Drawing& drawing, const Eigen::Isometry3d& T_robot_camera);
  ~EmbreeOracle();
  EmbreeOracle(const EmbreeOracle&) = delete;
  EmbreeOracle& operator=(const EmbreeOracle&) = delete;

  /// z of what a ray (x, y, 1) hits beyond `nearest_m`; infinite: nothing.
  double Cast(const Eigen::Vector3d& ray, double nearest_m) const;

 private:
  void AddMesh(const DrawnMesh& mesh, const Eigen::Isometry3d& T_camera_robot);
  void AddRound(const DrawnRound& shape, const Eigen::Isometry3d& T_camera_robot);
  void AddPrism(const DrawnRound& shape, const Eigen::Isometry3d& T_camera_shape);
  void Attach(RTCGeometry geometry);

  RTCDevice device_;
  RTCScene scene_;
};

/// How a range image compares with what Embree finds.
struct Comparison {
  int pixels = 0;          ///< on which something is seen
  int silhouette = 0;      ///< off, but right for a ray within 1e-3 px
  int wrong = 0;           ///< off by more than 0.01 mm otherwise
  double largest_m = 0.0;  ///< deviation of the others
  std::string first_wrong;
};
Comparison CompareWithEmbree(const rgbd::RangeImage& range, const rgbd::CameraModel& camera,
                             const EmbreeOracle& oracle, double nearest_m);

}  // namespace palpate::virtual_camera
