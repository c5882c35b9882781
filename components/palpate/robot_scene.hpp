// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>

#include "components/view/picture/scene.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// The deformed body coloured by displacement, its undeformed outline, its clamp, its cables and a
/// floor. `x_m` [3n]: node positions. Title, forces and points are the caller's to add.
view::Scene MakeRobotScene(const robot::RobotModel& model, const Eigen::VectorXd& x_m);

/// Observed markers as balls, those of the model as crosses. Both [3 x m], robot frame.
void AddMarkers(const Eigen::Matrix3Xd& observed_m, const Eigen::Matrix3Xd& model_m,
                view::Scene* scene);

/// The undeformed body in one colour with its clamp, cables, markers, and the points at which
/// contacts are searched.
view::Scene MakeUndeformedScene(const robot::RobotModel& model);

/// An arrow for a force; `metres_per_newton` sets its length.
void AddForce(const Eigen::Vector3d& at_m, const Eigen::Vector3d& force_N, double metres_per_newton,
              const view::Color& color, const std::string& label, view::Scene* scene);

/// Length of the diagonal of the body's bounding box, m.
double BodyDiagonal_m(const robot::RobotBody& body);

}  // namespace palpate::command
