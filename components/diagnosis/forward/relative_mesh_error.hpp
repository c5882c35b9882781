// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// By how much farther a mesh of half the element size lets markers and surface points move, as a
/// share of their motion: RMS over these points, under the weight and the tension of each cable, by
/// the stiffness at rest. Both meshes are of elements of ten nodes: what these add to elements of
/// four is a fault (MeshError). Nothing where the finer mesh would be too large, or nothing moves.
std::optional<double> RelativeMeshError(const robot::RobotBody& body);

}  // namespace palpate::diagnosis
