// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "components/diagnosis/forward/fault_model.hpp"

namespace palpate::diagnosis {

/// What is seen moves by z.head(3), m, and turns by z.tail(3), rad, about `middle_m`.
Eigen::Isometry3d ViewMotion(const Eigen::VectorXd& z, const Eigen::Vector3d& middle_m);

/// Adds what a little more of one of these six than `z` does to where the target is seen.
/// `T_after`: what the move that `z` makes is followed by.
void AddViewMotion(int parameter, const Eigen::VectorXd& z, const Eigen::Vector3d& middle_m,
                   const Eigen::Isometry3d& T_after, const FaultContext& at,
                   Eigen::Matrix3Xd* motion_m);

}  // namespace palpate::diagnosis
