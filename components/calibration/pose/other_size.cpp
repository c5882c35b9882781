// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/other_size.hpp"

#include <vector>

namespace palpate::calibration {

namespace {

/// Finer or more steps find more sizes and cost one assignment each.
struct OtherSizeTuning {
  /// Ratio of neighbouring sizes: distances of half the robot's differ by less than hypotheses
  /// allow.
  double step = 1.04;
  int steps = 13;  ///< in each direction: 0.6 to 1.7
  /// Share of the points that must match: at some size five points always do.
  double least_share = 0.8;
};
constexpr OtherSizeTuning kOtherSizeTuning;

/// Sizes of the matched points and markers.
SizeComparison Compare(const MarkerShapes& shapes, const Eigen::Matrix3Xd& points_m,
                       const MarkerAssignment& found) {
  std::vector<int> points, markers;
  for (std::size_t p = 0; p < found.marker_of_point.size(); ++p) {
    if (found.marker_of_point[p] < 0) continue;
    points.push_back(static_cast<int>(p));
    markers.push_back(found.marker_of_point[p]);
  }
  SizeComparison sizes;
  sizes.Add(points_m(Eigen::all, points), shapes.Positions_m(found.tension_N)(Eigen::all, markers));
  return sizes;
}

}  // namespace

std::optional<SizeComparison> FindOtherSize(const MarkerShapes& shapes,
                                            const Eigen::Matrix3Xd& points_m,
                                            const AssignmentSettings& settings) {
  double scale = 1.0;
  for (int step = 1; step <= kOtherSizeTuning.steps; ++step) {
    scale *= kOtherSizeTuning.step;
    for (const double larger : {scale, 1.0 / scale}) {
      const MarkerAssignment found = AssignMarkers(shapes, points_m / larger, settings);
      const bool fits = found.status.ok() || found.ambiguous;
      if (!fits ||
          found.matches < kOtherSizeTuning.least_share * static_cast<double>(points_m.cols()))
        continue;
      const SizeComparison sizes = Compare(shapes, points_m, found);
      if (sizes.Disagrees()) return sizes;
    }
  }
  return std::nullopt;
}

}  // namespace palpate::calibration
