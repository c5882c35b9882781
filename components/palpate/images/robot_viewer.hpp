// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

#include "components/perception/perception.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::command {

/// Where the robot is thought to be in a picture.
struct ExpectedNodes {
  Eigen::Matrix3Xf nodes_m;  ///< [3 x n] robot frame
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// Tells the robot from all else in recorded pictures, one after the other.
class RobotViewer {
 public:
  /// `body` must outlive it. Throws InputError for settings that do not go together.
  RobotViewer(const perception::Config& config, const robot::RobotBody& body);

  /// What perception makes of a picture; `expected`: nullptr where nobody knows. Holds until the
  /// next call. `sequence` must be there as long as its pictures are looked at. Throws InputError
  /// where a file cannot be read.
  const perception::SegmentedFrame& Look(const experiment::RgbdSequence& sequence,
                                         std::size_t picture, const ExpectedNodes* expected);
  /// As it was read.
  const rgbd::RgbdFrame& images() const { return images_; }

 private:
  perception::Perception perception_;
  Eigen::Matrix3Xi triangles_;
  const experiment::RgbdSequence* opened_ = nullptr;
  rgbd::RgbdFrame images_;
};

}  // namespace palpate::command
