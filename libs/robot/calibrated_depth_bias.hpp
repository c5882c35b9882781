// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/core/status.hpp"
#include "libs/geometry/depth_bias_map.hpp"
#include "libs/geometry/depth_picture.hpp"

namespace palpate::robot {

/// Systematic error of the depth, estimated together with the camera pose. It holds for images of
/// that camera at that size.
struct CalibratedDepthBias {
  geometry::DepthPicture picture;
  geometry::DepthBiasMap map;
};

/// The keys of the block `depth_bias:`.
const KeyTable& DepthBiasKeys();

/// The block `depth_bias:` of a calibration file. Throws InputError with file:line:column, also
/// where the covariance is none (not [6 + k] rows of a lower triangle, or not positive
/// semidefinite).
CalibratedDepthBias ReadDepthBias(const ConfigNode& node);
std::string FormatDepthBias(const CalibratedDepthBias& bias);

/// kInvalidInput where it holds no numbers of the sizes that belong together, or a covariance that
/// is none.
Status CheckDepthBias(const CalibratedDepthBias& bias);

/// kInvalidInput, naming both sides, where it is for images of another size or lens.
Status CheckDepthPicture(const CalibratedDepthBias& bias, const geometry::DepthPicture& present);

}  // namespace palpate::robot
