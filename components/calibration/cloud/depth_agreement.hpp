// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>

#include "components/calibration/cloud/pose_search.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/rgbd/depth_noise.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::calibration {

/// A whole depth image, and the shape in which the robot should be seen in it.
struct DepthSight {
  std::string name;  ///< for messages
  rgbd::RgbdCamera camera;
  rgbd::DepthNoise noise;
  rgbd::DepthImage depth;
  Eigen::VectorXd x_m;  ///< [3n] nodes of the model under the frame's inputs, robot frame
};

/// What would be otherwise if a mistake in data or settings were mended: factors on lengths.
struct Mend {
  double depth = 1.0;   ///< on measured depths
  double body = 1.0;    ///< on the robot's size, about its frame's origin
  double lens = 1.0;    ///< on fx, fy, cx and cy
  double motion = 1.0;  ///< on the displacements of the model's nodes
};

/// How a depth image shows a surface that should be there. Counts are of pixels.
struct DepthAgreement {
  double agree = 0.0;
  double farther = 0.0;    ///< one sees through the surface
  double nearer = 0.0;     ///< something hides it, or it is elsewhere
  double rims = 0.0;       ///< at the outline, of those that agree
  double open_rims = 0.0;  ///< of these, those beyond which the measured surface goes on
  double in_view = 0.0;    ///< share of the surface's vertices that are inside of the image

  /// Share of the visible surface that the image contradicts, in [0, 1]. What is nearer counts
  /// half: it may be another object.
  double Misfit() const;
};

/// Compares depth images with the robot's surface at any pose.
class DepthComparison {
 public:
  /// `rest_m` [3n] undeformed nodes. Arguments must outlive the comparison.
  DepthComparison(const robot::RobotBody& body, const Eigen::VectorXd& rest_m,
                  const DepthSight& sight);

  DepthAgreement Compare(const geometry::RigidTransform& T_robot_camera, const Mend& mend) const;
  /// The measured points within `reach_m` of where the robot should be, one for each `spacing_m`,
  /// camera frame.
  ThinCloud CloudNear(const geometry::RigidTransform& T_robot_camera, const Mend& mend,
                      double reach_m, double spacing_m) const;
  /// Measured over expected depth, median of the pixels where the robot should be; NaN: none.
  double DepthRatio(const geometry::RigidTransform& T_robot_camera) const;
  /// [3n] nodes.
  Eigen::VectorXd ShapeOf(const Mend& mend) const;
  const rgbd::RgbdCamera& camera() const { return sight_.camera; }

 private:
  rgbd::CameraModel LensOf(const Mend& mend) const;
  double Tolerance_m(double z_m, double motion_m, const Mend& mend) const;

  const DepthSight& sight_;
  const Eigen::VectorXd& rest_m_;
  Eigen::Matrix3Xi triangles_;
  Eigen::VectorXd motion_m_;  ///< [n] distance of the nodes from rest
  double extent_m_;
  int step_px_;             ///< of the pixels that are used
  rgbd::CameraModel lens_;  ///< of these pixels
  rgbd::RangeImage z_m_;    ///< of these pixels; 0: nothing
};

}  // namespace palpate::calibration
