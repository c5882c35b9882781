// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/experiment/cloud/point_cloud.hpp"

namespace palpate::experiment {

/// Reads the vertices of a PLY file (G. Turk, The PLY Polygon File Format, 1994): ascii,
/// binary_little_endian, binary_big_endian. x, y, z are needed; red, green, blue as bytes are taken
/// (all three); other properties and elements are skipped. Organised where `obj_info num_cols` and
/// `num_rows` say so and fit the count of vertices. A vertex with a coordinate that is not finite
/// is none. Throws InputError with file:line for a header that is incomplete or contradicts itself,
/// for a file that is cut short, and for what is no number.
PointCloud ReadPly(const std::filesystem::path& file);

/// Writes binary_little_endian with 32-bit floats and, where there are colours, bytes. Throws
/// RunError where it cannot.
void WritePly(const PointCloud& cloud, const std::filesystem::path& file);

}  // namespace palpate::experiment
