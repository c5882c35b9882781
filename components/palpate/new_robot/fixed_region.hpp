// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"
#include "components/palpate/new_robot/decision.hpp"
#include "components/palpate/new_robot/source_mesh.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::command {

/// What of a body does not move.
struct FixedRegion {
  std::vector<int> nodes;  ///< of BodyShape::mesh, rising
  std::vector<geometry::Box> boxes;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Decision decision;
};

/// The region that `words` name together, each a group of the mesh file, an end of the mesh along
/// an axis ("z_min"), or the corners of a box ("x,y,z;x,y,z", in the unit of the mesh file). Throws
/// InputError where a word names nothing, with what there is, and where the nodes span no triangle.
FixedRegion FixedByWords(const std::vector<std::string>& words, const SourceMesh& source,
                         const BodyShape& shape, double metres_per_unit);

/// The best guess: a group whose name says so; else a flat end of the body, by its shape, by
/// `pull_points_m` (where cables are pulled from, may be empty) and by gravity.
FixedRegion GuessFixed(const SourceMesh& source, const BodyShape& shape,
                       const std::vector<Eigen::Vector3d>& pull_points_m,
                       const Eigen::Vector3d& up);

/// The ends and groups that FixedByWords takes, for a message.
std::string FixedChoices(const SourceMesh& source);

}  // namespace palpate::command
