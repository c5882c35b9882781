// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/embedding.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::robot {

/// Polylines [3 x >= 2] of a fibre, rest positions, robot frame: the path of the robot file, or
/// chords of a winding. A helix is one polyline, rings are closed ones. A helix begins on the side
/// of +x of its axis, of +y where the axis is along x.
std::vector<Eigen::Matrix3Xd> FibrePaths(const FibreSettings& fibre);

/// Lays a fibre of the robot file through the body. Throws InputError at the setting where a piece
/// of it lies farther from the body than 1 mm, or 1 % of the body's diagonal if that is less.
BodyFibre LayFibre(const FibreSettings& settings, const fem::PointLocator& locator,
                   double inextensible_N);

/// The axial stiffness that stands for inextensible: of 30 cross-sections of the body, at the
/// largest of its moduli. The cross-section is the volume over the diagonal of the mesh. A fibre is
/// no constraint, so that K stays positive definite, of the same pattern and well scaled.
double InextensibleStiffness_N(const fem::TetMesh& mesh,
                               const std::vector<fem::Material>& materials);

}  // namespace palpate::robot
