// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/robot/robot_body.hpp"

namespace palpate::force_estimation {

/// How large and how stiff a robot is. What depends on that in the estimation is a share of these.
struct BodyScale {
  double length_m = 0.0;  ///< diagonal of the box about the undeformed body
  /// Push on a feature point that moves it inwards by `length_m`, by the stiffness of the
  /// undeformed body without actuators: the median over the feature points.
  double force_N = 0.0;
};

/// Takes as long as a factorisation and as many solutions as there are feature points. Throws
/// InputError where none of these can move.
BodyScale ScaleOf(const robot::RobotBody& body);

}  // namespace palpate::force_estimation
