// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/hidden_surface.hpp"

#include <cmath>

#include "components/perception/contacts/point_grid.hpp"

namespace palpate::perception {

std::optional<HiddenSurface> FindHiddenSurface(const PredictedSurface& surface,
                                               const rgbd::SensedCloud& robot,
                                               const Eigen::Matrix3Xd& rim_m, double reach_m,
                                               double resolution_m,
                                               const HiddenSurfaceTuning& tuning) {
  const Eigen::Vector3d middle_m = rim_m.rowwise().mean();
  const double rim_reach_m = (rim_m.colwise() - middle_m).colwise().norm().maxCoeff();
  const SurfaceAround around(surface, middle_m, rim_reach_m + tuning.most_reaches * reach_m,
                             tuning.around);
  PointGrid seen;
  seen.Build(robot.points_m, static_cast<float>(resolution_m));
  double sum = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  around.ForEachPart([&](const Eigen::Vector3d& place_m, double area_m2) {
    const double from_rim_m2 = (rim_m.colwise() - place_m).colwise().squaredNorm().minCoeff();
    if (from_rim_m2 > tuning.most_reaches * tuning.most_reaches * reach_m * reach_m) return;
    bool is_seen = false;
    seen.ForEachNear(place_m.cast<float>(), static_cast<float>(resolution_m), [&](int, float) {
      is_seen = true;
      return false;
    });
    if (is_seen) return;
    const double weight = area_m2 * std::exp(-0.5 * from_rim_m2 / (reach_m * reach_m));
    const Eigen::Vector3d off_m = place_m - middle_m;
    sum += weight;
    first += weight * off_m;
    second += weight * off_m * off_m.transpose();
  });
  if (!(sum > 0.0)) return std::nullopt;
  const Eigen::Vector3d mean_m = first / sum;
  return HiddenSurface{.middle_m = middle_m + mean_m,
                       .covariance_m2 = second / sum - mean_m * mean_m.transpose()};
}

}  // namespace palpate::perception
