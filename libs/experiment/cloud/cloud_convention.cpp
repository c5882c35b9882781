// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/cloud/cloud_convention.hpp"

#include <cmath>
#include <vector>

#include "libs/core/statistics.hpp"

namespace palpate::experiment {

std::optional<CloudConvention> ConventionOf(const PointCloud& cloud) {
  constexpr double kFarthest_m = 50.0;
  std::vector<double> distances;
  bool behind = true;
  for (const double z : cloud.points_m.row(2)) {
    if (!std::isfinite(z) || z == 0.0) continue;  // 0: a pixel without depth
    behind = behind && z < 0.0;
    distances.push_back(std::abs(z));
  }
  if (distances.empty()) return std::nullopt;
  return CloudConvention{.y_and_z_negated = behind,
                         .millimetres = UpperMedian(distances) > kFarthest_m};
}

std::string ToText(const CloudConvention& convention) {
  std::string text;
  if (convention.y_and_z_negated) {
    text =
        "all points lie behind the camera (z < 0), as the RealSense Viewer writes them: y and z "
        "are negated";
  }
  if (convention.millimetres) {
    text += std::string(text.empty() ? "" : "; ") +
            "half of the points are farther than 50 m: they are taken for millimetres";
  }
  return text;
}

void ToOpticalFrame(const CloudConvention& convention, PointCloud* cloud) {
  if (convention.y_and_z_negated) cloud->points_m.bottomRows<2>() *= -1.0;
  if (convention.millimetres) cloud->points_m *= 1e-3;
}

}  // namespace palpate::experiment
