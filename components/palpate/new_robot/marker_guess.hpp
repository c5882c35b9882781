// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"
#include "components/palpate/new_robot/channels.hpp"
#include "components/palpate/new_robot/fixed_region.hpp"
#include "components/palpate/new_robot/source_mesh.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

/// Points of the mesh file whose name says that they are markers. Frame of the mesh file, m.
std::vector<robot::MarkerSettings> NamedMarkers(const SourceMesh& source, const BodyShape& shape);

/// `count` places for markers m1, m2, ..., spread over the outer surface that moves.
std::vector<robot::MarkerSettings> SpreadMarkers(const BodyShape& shape, const FixedRegion& fixed,
                                                 const std::vector<Channel>& channels, int count);

/// The outer faces that something can touch: not fixed, and no wall of a channel.
std::vector<int> FreeFaces(const BodyShape& shape, const FixedRegion& fixed,
                           const std::vector<Channel>& channels);

}  // namespace palpate::command
