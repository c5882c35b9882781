// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "components/diagnosis/data/surface_measurement.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::diagnosis {

/// What was seen of the robot in one depth frame of a sample.
struct SeenCloud {
  DepthFrame frame;
  rgbd::SensedCloud cloud;   ///< of the robot alone, camera frame; empty: it was not seen
  std::uint64_t digest = 0;  ///< SegmentedCloud::digest
  std::string why_not = {};  ///< it was not seen
  /// [features] mean over the surface where the robot was thought to be when it was matched last;
  /// NaN: not seen. Empty: nothing was matched.
  Eigen::VectorXd height_m = {};
};

/// [samples] by time.
using SurfaceClouds = std::vector<std::vector<SeenCloud>>;

}  // namespace palpate::diagnosis
