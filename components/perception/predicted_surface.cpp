// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/predicted_surface.hpp"

namespace palpate::perception {

PredictedSurface MakePredictedSurface(const Eigen::Ref<const Eigen::Matrix3Xf>& nodes_m,
                                      const Eigen::Ref<const Eigen::Matrix3Xi>& triangles,
                                      const Eigen::Isometry3d& T_robot_camera) {
  const Eigen::Isometry3d T_camera_robot = T_robot_camera.inverse();
  return {T_camera_robot * nodes_m.cast<double>(), triangles};
}

}  // namespace palpate::perception
