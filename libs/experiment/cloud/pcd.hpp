// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/experiment/cloud/point_cloud.hpp"

namespace palpate::experiment {

/// Reads the Point Cloud Library's PCD, version 0.7 and before: ascii, binary, binary_compressed.
/// x, y, z are needed; rgb or rgba (packed 0xRRGGBB in a float or whole number) is taken, other
/// fields are skipped, as is VIEWPOINT: points stay as they are. A point with a coordinate that is
/// not finite is none. Throws InputError with file:line for a header that is incomplete or
/// contradicts itself, for a file that is cut short, and for what is no number.
PointCloud ReadPcd(const std::filesystem::path& file);

/// Writes DATA binary with x y z as 32-bit floats and, where there are colours, rgb. Throws
/// RunError where it cannot.
void WritePcd(const PointCloud& cloud, const std::filesystem::path& file);

}  // namespace palpate::experiment
