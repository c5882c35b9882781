// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/fem/embedding.hpp"
#include "libs/fem/enclosed_volume.hpp"
#include "libs/fem/mesh_io/node_group.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::robot {

/// The wall of a chamber: faces of the mesh's boundary that look into the chamber, or the triangles
/// of a file, whose vertices move with the body. Throws InputError at the setting for a surface
/// that is not there, is open (with the edge), lies inside the material or on the outside of the
/// body, encloses no volume, cuts itself (with the triangles), or is turned inside out.
/// `groups` are those of the mesh file.
fem::MovingSurface ChamberWall(const ChamberSettings& chamber, const MeshSettings& placement,
                               const fem::PointLocator& locator,
                               const std::vector<fem::NodeGroup>& groups);

/// Faces of a mesh's boundary, turned round: seen from the chamber, its outside is the material.
fem::MovingSurface WallOfFaces(const fem::BoundarySurface& boundary, const std::vector<int>& faces);

}  // namespace palpate::robot
