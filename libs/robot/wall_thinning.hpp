// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/enclosed_volume.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::robot {

/// Rest shape mode [3n] of a chamber that is larger than drawn, and its walls thinner: per metre,
/// `wall` moves by one metre into the material along its normal. The motion falls linearly to zero
/// at all other surfaces of the body: they stay. Between them it depends on the place alone, so
/// that meshes of one body have the same.
Eigen::VectorXd WallThinning(const fem::TetMesh& mesh, const fem::BoundarySurface& boundary,
                             const fem::MovingSurface& wall);

}  // namespace palpate::robot
