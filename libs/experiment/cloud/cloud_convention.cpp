// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/cloud_convention.hpp"

#include <cmath>
#include <vector>

#include "libs/core/statistics.hpp"

namespace palpate::experiment {

namespace {

/// Depth cameras see from about 0.15 m on, and a robot is not 10 m away.
double UnitOf_m(double distance) {
  if (distance <= 10.0) return 1.0;
  return distance < 150.0 ? 0.01 : 0.001;
}

}  // namespace

std::optional<CloudConvention> ConventionOf(const PointCloud& cloud) {
  std::vector<double> distances;
  bool behind = true;
  for (const double z : cloud.points_m.row(2)) {
    if (!std::isfinite(z) || z == 0.0) continue;  // 0: a pixel without depth
    behind = behind && z < 0.0;
    distances.push_back(std::abs(z));
  }
  if (distances.empty()) return std::nullopt;
  return CloudConvention{.y_and_z_negated = behind, .unit_m = UnitOf_m(UpperMedian(distances))};
}

std::string ToText(const CloudConvention& convention) {
  std::string text;
  if (convention.y_and_z_negated) {
    text =
        "all points lie behind the camera (z < 0), as the RealSense Viewer writes them: y and z "
        "are negated";
  }
  if (convention.unit_m < 1.0) {
    const bool millimetres = convention.unit_m < 0.01;
    text += std::string(text.empty() ? "" : "; ") + "half of the points are farther than " +
            (millimetres ? "150 m: they are taken for millimetres"
                         : "10 m: they are taken for centimetres");
  }
  return text;
}

void ToOpticalFrame(const CloudConvention& convention, PointCloud* cloud) {
  if (convention.y_and_z_negated) cloud->points_m.bottomRows<2>() *= -1.0;
  cloud->points_m *= convention.unit_m;
}

}  // namespace palpate::experiment
