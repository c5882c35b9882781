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

/// The predicted nodes of the robot in a frame.
struct ExpectedNodes {
  Eigen::Matrix3Xf nodes_m;  ///< [3 x n] robot frame
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
};

/// Segments the robot in recorded frames, one after the other.
class RobotViewer {
 public:
  /// `body` must outlive it. Throws InputError for settings that do not go together.
  RobotViewer(const perception::Config& config, const robot::RobotBody& body);

  /// The segmented frame; `expected`: nullptr without a prediction. Valid until the next call.
  /// `sequence` must outlive the calls with its frames. Throws InputError where a file cannot be
  /// read.
  const perception::SegmentedFrame& Look(const experiment::RgbdSequence& sequence,
                                         std::size_t index, const ExpectedNodes* expected);
  /// The frame as it was read.
  const rgbd::RgbdFrame& images() const { return images_; }

 private:
  perception::Perception perception_;
  Eigen::Matrix3Xi triangles_;
  const experiment::RgbdSequence* opened_ = nullptr;
  rgbd::RgbdFrame images_;
};

}  // namespace palpate::command
