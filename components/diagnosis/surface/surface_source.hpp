// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "libs/core/status.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::diagnosis {

/// Where the robot is thought to be in a depth frame.
struct ExpectedShape {
  Eigen::Matrix3Xf nodes_m;  ///< [3 x nodes] robot frame
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// What a depth frame shows of the robot.
struct SegmentedCloud {
  Status status;            ///< why nothing of it, or ok
  rgbd::SensedCloud cloud;  ///< points of the robot alone, camera frame
  std::uint64_t digest =
      0;  ///< of all that was measured: alike in two depth frames only if they are
};

/// The depth frames of an experiment. Segmentation of the robot is up to the implementation.
class SurfaceSource {
 public:
  SurfaceSource() = default;
  virtual ~SurfaceSource() = default;
  SurfaceSource(const SurfaceSource&) = delete;
  SurfaceSource& operator=(const SurfaceSource&) = delete;

  /// `recording`: index into the experiment's; `depth frame`: number in it, by time. Depth frames
  /// of a recording are asked for by rising time, or all over again. Throws InputError where a file
  /// cannot be read.
  virtual SegmentedCloud Segment(int recording, int frame, const ExpectedShape& expected) = 0;
  /// The camera of a recording, as its data sheet has it. Throws InputError where it is not given.
  virtual rgbd::RgbdCamera Camera(int recording) = 0;
};

}  // namespace palpate::diagnosis
