// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "components/calibration/joint/joint_calibration.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The picture that points were found in, in the depth camera's pixels; empty: there is none.
struct PictureGround {
  rgbd::ColorImage color;
  rgbd::CameraModel lens;
};

/// One setting of the cables.
struct AssignmentPanel {
  std::string name;
  /// Camera frame; `marker` is the robot's that each is, -1: none of them.
  std::vector<calibration::MarkerSighting> points;
  Eigen::Matrix3Xd model_m;  ///< [3 x markers] where the calibrated model has them, camera frame
  PictureGround ground;
};

/// The model's markers in a state of its nodes x_m [3n], as the camera sees them: [3 x markers].
Eigen::Matrix3Xd MarkersInCamera(const robot::RobotModel& model, const Eigen::VectorXd& x_m,
                                 const geometry::RigidTransform& T_robot_camera);

/// Draws which point is which marker (SVG): the points with the ellipse that holds 95 % of them,
/// the model's markers, the way between (both enlarged, as the legend says) and its length in mm;
/// markers that were not seen, and points that are none. On the picture where there is one, else
/// straight along the axis in which they are flattest. Throws RunError where the file cannot be
/// written.
void DrawAssignment(const std::filesystem::path& file, const std::vector<std::string>& marker_names,
                    const std::vector<AssignmentPanel>& panels);

/// The same of markers that have names. `fit`: what was found from these frames.
void DrawFrames(const std::filesystem::path& file,
                const std::vector<calibration::CalibrationFrame>& frames,
                const calibration::JointCalibration& fit, const robot::RobotModel& model);

}  // namespace palpate::command
