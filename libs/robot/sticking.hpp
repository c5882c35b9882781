// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::robot {

/// m that a cable moves in an eyelet, elastically, from where it pulls neither way to where it
/// slides: sharper laws are harder to follow and no truer of silicone.
inline constexpr double kPresliding_m = 5e-5;

/// What sticks and slides (CableFriction::sliding) after a step in which each eyelet's cable would
/// slide by `freely_m` [eyelets], were friction to stay as it was at `before` [eyelets]; `slide_m`
/// [eyelets x eyelets]: by how much more per what each changes by.
Eigen::VectorXd StickOrSlide(const Eigen::VectorXd& before, const Eigen::VectorXd& freely_m,
                             const Eigen::MatrixXd& slide_m);

}  // namespace palpate::robot
