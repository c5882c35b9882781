// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/shape/camera_biases.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/surface_map.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::test_support {

/// Smallest standard deviation that an unbiased estimate of |F| can have, as a share of |F|
/// (Cramer-Rao), of a contact whose place on the surface and force in space are unknown, as are
/// those of the others, friction known to a sigma of 0.3 of the push.
struct ForceBound {
  double noise = 0.0;     ///< by the depth noise alone
  double whole = 0.0;     ///< with what is left of the depth bias, and with the model's error
  double at_place = 0.0;  ///< the same where the place is known
};

/// What the robot file's features tell of forces at best, to first order about the true ones.
class ForceBounds {
 public:
  /// `model` must outlive this.
  ForceBounds(robot::RobotModel& model, const force_estimation::ShapeConfig& shape);

  /// Contact-free frames with equal cable inputs, from which the depth bias is estimated.
  /// Throws RunError where the model has no equilibrium or nothing is seen.
  void Learn(const std::vector<force_estimation::ShapeFrame>& frames);
  /// Of each of the forces that are held at once in `frames` frames like `frame`. Throws RunError.
  std::vector<ForceBound> Of(const std::vector<virtual_robot::TrueForce>& truths,
                             const force_estimation::ShapeFrame& frame, int frames);

 private:
  struct Rows;
  Rows RowsOf(const force_estimation::ShapeFrame& frame, const Eigen::VectorXd& x_m, int frames);
  fem::StaticState Balance(const std::vector<virtual_robot::TrueForce>& truths,
                           const force_estimation::ShapeFrame& frame);
  Eigen::MatrixXd Jacobian(const virtual_robot::TrueForce& truth,
                           const force_estimation::ObservationJacobian& responses);

  robot::RobotModel& model_;
  force_estimation::ShapeConfig shape_;
  correspondence::SurfaceFeatures features_;
  force_estimation::SurfaceMatching matching_;
  force_estimation::SurfaceMap map_;
  force_estimation::CameraBiases bias_;
  fem::StaticState untouched_;
};

}  // namespace palpate::test_support
