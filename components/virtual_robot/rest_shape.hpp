// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_robot/bench_body.hpp"

namespace palpate::virtual_robot {

/// The body's own long axis: from the middle of what is clamped towards the middle of the body.
struct BodyAxis {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};
BodyAxis FindBodyAxis(const fem::TetMesh& mesh, const fem::FixedDirections& fixed);

/// What changes `body->mesh`, the shape at rest (and `body->assembled_m`), in this order:
/// geometry_scale about the middle of the clamp; rest_twist about the body's axis, in proportion to
/// the distance from the clamp; plastic_set along the lowest mode of vibration, its largest
/// displacement being `tip_m`. Throws InputError.
void ApplyRestShapeEffects(const Effects& effects, BenchBody* body);

}  // namespace palpate::virtual_robot
