// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/core/status.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::geometry {

struct Registration {
  Status status;  ///< kUnobservable: fewer than 3 points, or all on one line
  RigidTransform T_target_source;
  double rms_m = 0.0;  ///< root mean square distance of the pairs after the motion
};

/// The rigid motion that takes `source_m` to `target_m` (column k to column k, [3 x n] both) with
/// the least sum of squared distances, never a reflection. Arun, Huang, Blostein (1987), with the
/// sign rule of Umeyama (1991), eqs. (40)-(43). Refuses values that are not finite.
Registration RegisterRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& source_m,
                           const Eigen::Ref<const Eigen::Matrix3Xd>& target_m);

}  // namespace palpate::geometry
