// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/geometry/triangle_surface.hpp"

namespace palpate::fem {

/// Reads a surface as STL, ASCII or binary. Corners at the same place, to the last bit, become one
/// vertex, in the order in which they first appear; normals of the file are passed over. Lengths
/// are multiplied by `metres_per_unit` (> 0). Throws InputError for a file that is not there, is no
/// STL, is cut off, holds no triangle, or a coordinate that is not finite.
geometry::TriangleSurface ReadStl(const std::filesystem::path& file, double metres_per_unit);

}  // namespace palpate::fem
