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

/// The image that the points were found in, in the depth camera's pixels; empty: none.
struct PlotGround {
  rgbd::ColorImage color;
  rgbd::CameraModel lens;
};

/// One setting of the cables.
struct AssignmentPanel {
  std::string name;
  /// Camera frame; `marker`: index of the robot's marker, -1: none.
  std::vector<calibration::MarkerSighting> points;
  Eigen::Matrix3Xd model_m;  ///< [3 x markers] of the calibrated model, camera frame
  PlotGround ground;
};

/// The model's markers with the nodes at x_m [3n], camera frame: [3 x markers], m.
Eigen::Matrix3Xd MarkersInCamera(const robot::RobotModel& model, const Eigen::VectorXd& x_m,
                                 const geometry::RigidTransform& T_robot_camera);

/// Draws the assignment of points to markers (SVG): the points with their 95 % ellipses, the
/// model's markers, the line between (both enlarged, as the legend says) and its length in mm;
/// markers that were not seen, and points that are no marker. Drawn on the image where there is
/// one, else projected along the axis in which the points are flattest. Throws RunError where the
/// file cannot be written.
void DrawAssignment(const std::filesystem::path& file, const std::vector<std::string>& marker_names,
                    const std::vector<AssignmentPanel>& panels);

/// The same of markers with names, in the frames that the calibrated camera sees. `fit`: the
/// calibration from all of these frames.
void DrawFrames(const std::filesystem::path& file,
                const std::vector<calibration::CalibrationFrame>& frames,
                const calibration::JointCalibration& fit, const robot::RobotModel& model);

}  // namespace palpate::command
