// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/palpate/new_robot/body_shape.hpp"

namespace palpate::command {

/// The flat ends of a body: parts of its outer surface in one plane, which may be several (the
/// soles of feet), with all of the body behind that plane. Parts below a thousandth of the surface
/// are left out. The largest first.
std::vector<FlatFace> FindFlatFaces(const BodyShape& shape);

}  // namespace palpate::command
