// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>

#include "libs/experiment/cloud/point_cloud.hpp"

namespace palpate::experiment {

/// How a program writes the points of a camera that looks along +z, in metres, y down.
struct CloudConvention {
  bool y_and_z_negated = false;  ///< RealSense Viewer and rs-convert: y up, z backwards
  double unit_m = 1.0;           ///< 0.001: Zivid, Azure Kinect; 0.01: modelling programs
};

/// What the points show: all behind the camera, or half of them farther from it than a depth camera
/// sees a robot. Then the unit is what makes that distance one. nullopt: there are no points.
std::optional<CloudConvention> ConventionOf(const PointCloud& cloud);

/// One sentence; empty for metres in the optical frame.
std::string ToText(const CloudConvention& convention);

/// To metres in the camera's optical frame.
void ToOpticalFrame(const CloudConvention& convention, PointCloud* cloud);

}  // namespace palpate::experiment
