// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/rgbd/image.hpp"

namespace palpate::virtual_camera {

/// Depth of an organised PCD file as PCL writes it (DATA binary_compressed, float x y z among its
/// fields); |z|, NaN where there is none. Throws std::runtime_error for anything else.
rgbd::RangeImage ReadOrganisedCloud(const std::filesystem::path& file);

}  // namespace palpate::virtual_camera
