// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/pose_error.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "libs/core/check.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::force_estimation {

PoseError StatedPoseError(const experiment::Experiment& experiment,
                          const experiment::Recording& recording) {
  if (experiment::FrameOf(experiment, recording) == experiment::MeasurementFrame::kRobot) return {};
  const auto pose = experiment::RobotFromMarkers(experiment, recording);
  const auto* T_robot_camera = std::get_if<Eigen::Isometry3d>(&pose);
  if (T_robot_camera == nullptr) return {};
  const geometry::PoseStandardError error = experiment::PoseErrorOf(experiment, recording);
  return {.about_m = T_robot_camera->translation(),
          .translation_sigma_m = error.translation_m,
          .rotation_sigma_rad = error.rotation_rad};
}

PoseError CalibratedPoseError(const robot::CalibratedPose& pose, const Eigen::Vector3d& middle_m) {
  const Eigen::Vector3d lever_m = pose.T_robot_camera.translation() - middle_m;
  const Eigen::Vector3d by_turn_m2 =
      geometry::CrossMatrix(lever_m).cwiseAbs2() * pose.rotation_error_rad.cwiseAbs2();
  const Eigen::Vector3d rest_m2 = pose.translation_error_m.cwiseAbs2() - by_turn_m2;
  return {.about_m = middle_m,
          .translation_sigma_m = std::sqrt(std::max(0.0, rest_m2.maxCoeff())),
          .rotation_sigma_rad = pose.rotation_error_rad.maxCoeff()};
}

Eigen::MatrixXd PoseErrorColumns(const PoseError& error, const Eigen::Matrix3Xd& points_m,
                                 const Eigen::Matrix3Xd& from_m) {
  PALPATE_CHECK(points_m.cols() == from_m.cols(), points_m.cols(), from_m.cols());
  Eigen::MatrixXd columns_m = Eigen::MatrixXd::Zero(3 * points_m.cols(), 6);
  for (Eigen::Index m = 0; m < points_m.cols(); ++m) {
    const bool is_displacement = from_m.col(m).allFinite();
    const Eigen::Vector3d about_m = is_displacement ? from_m.col(m).eval() : error.about_m;
    columns_m.block<3, 3>(3 * m, 0) =
        -error.rotation_sigma_rad * geometry::CrossMatrix(points_m.col(m) - about_m);
    if (is_displacement) continue;
    columns_m.block<3, 3>(3 * m, 3) = error.translation_sigma_m * Eigen::Matrix3d::Identity();
  }
  return columns_m;
}

}  // namespace palpate::force_estimation
