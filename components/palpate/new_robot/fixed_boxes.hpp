// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::command {

/// Boxes that hold the nodes `inside` (rising) and no other node that an element uses. A region
/// between planes along the axes takes one box, an oblique one several.
std::vector<geometry::Box> BoxesAround(const BodyShape& shape, const std::vector<int>& inside);

}  // namespace palpate::command
