// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/cloud_size.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace palpate::calibration {

namespace {

using geometry::RigidTransform;

/// Finer or more steps find more sizes and cost one search each.
struct CloudSizeTuning {
  /// Ratio of neighbouring sizes: the first kernel of the search reaches from one to the next, as
  /// half a step moves the ends of a robot of 0.2 m by 5 mm.
  double step = 1.1;
  int steps = 5;       ///< in each direction
  int fit_steps = 20;  ///< refinement of the best size
  double reach = 2.0;  ///< in widths of the kernel, distance of points on the surface
};
constexpr CloudSizeTuning kCloudSizeTuning;

/// Pose and coverage of a cloud that is `scale` times as large as the model.
struct SizedPose {
  double scale = 1.0;
  RigidTransform T_robot_camera;  ///< of the cloud over `scale`
  double surface_covered = 0.0;
};

std::vector<ThinCloud> Shrunk(const std::vector<ThinCloud>& clouds, double scale) {
  std::vector<ThinCloud> shrunk = clouds;
  for (ThinCloud& cloud : shrunk) cloud.points_m /= scale;
  return shrunk;
}

SizedPose BestOfSizes(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds,
                      const RigidTransform& start, PoseSearchSettings settings) {
  settings.good_cover = 0.0;  // no restarts
  SizedPose best;
  for (int step = -kCloudSizeTuning.steps;
       step <= kCloudSizeTuning.steps && !settings.stop.stop_requested(); ++step) {
    const double scale = std::pow(kCloudSizeTuning.step, step);
    const PoseFit fit = SearchPose(surfaces, Shrunk(clouds, scale),
                                   {start.rotation(), start.translation_m() / scale}, settings);
    if (fit.surface_covered > best.surface_covered)
      best = {scale, fit.T_robot_camera, fit.surface_covered};
  }
  return best;
}

/// Points near the surface and their nearest surface points.
struct Pairs {
  Eigen::Matrix3Xd points_m;  ///< camera frame, measured
  Eigen::Matrix3Xd here_m;    ///< robot frame, scaled to the model
  Eigen::Matrix3Xd feet_m, normals;
};

Pairs PairsOf(SurfaceInView& surface, const ThinCloud& cloud, const SizedPose& pose,
              double reach_m) {
  surface.LookFrom(pose.T_robot_camera);
  Pairs pairs{cloud.points_m, cloud.points_m, cloud.points_m, cloud.points_m};
  Eigen::Index count = 0;
  for (const auto& point_m : cloud.points_m.colwise()) {
    const Eigen::Vector3d here_m = pose.T_robot_camera * (point_m / pose.scale);
    const std::optional<SurfaceFoot> foot = surface.FootOf(here_m);
    if (!foot || foot->distance_m > reach_m) continue;
    pairs.points_m.col(count) = point_m;
    pairs.here_m.col(count) = here_m;
    pairs.feet_m.col(count) = foot->position_m;
    pairs.normals.col(count++) = foot->normal;
  }
  for (Eigen::Matrix3Xd* columns :
       {&pairs.points_m, &pairs.here_m, &pairs.feet_m, &pairs.normals}) {
    *columns = columns->leftCols(count).eval();
  }
  return pairs;
}

/// One Gauss-Newton step of rotation, translation and size, point to plane (Geman-McClure).
void Fit(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds, double width_m,
         SizedPose* pose) {
  Eigen::Matrix<double, 7, 7> matrix = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
  const Eigen::Vector3d eye_m = pose->T_robot_camera.translation_m();
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    const Pairs pairs = PairsOf(surfaces[f], clouds[f], *pose, kCloudSizeTuning.reach * width_m);
    for (Eigen::Index k = 0; k < pairs.here_m.cols(); ++k) {
      const Eigen::Vector3d here_m = pairs.here_m.col(k), normal = pairs.normals.col(k);
      const double off_m = normal.dot(pairs.feet_m.col(k) - here_m);
      const double root = 1.0 / (1.0 + off_m * off_m / (width_m * width_m));
      Eigen::Matrix<double, 7, 1> row;
      row << here_m.cross(normal), normal, -normal.dot(here_m - eye_m);
      matrix += root * root * row * row.transpose();
      right += root * root * off_m * row;
    }
  }
  matrix.diagonal().array() += 1e-9;
  const Eigen::Matrix<double, 7, 1> step =
      Eigen::LDLT<Eigen::Matrix<double, 7, 7>>(matrix).solve(right);
  const double angle_rad = step.head<3>().norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle_rad > 0.0) turn = Eigen::AngleAxisd(angle_rad, step.head<3>() / angle_rad);
  pose->T_robot_camera = RigidTransform(turn, step.segment<3>(3)) * pose->T_robot_camera;
  pose->scale *= std::exp(step[6]);
}

}  // namespace

std::optional<SizeComparison> FindOtherSize(std::vector<SurfaceInView>& surfaces,
                                            const std::vector<ThinCloud>& clouds,
                                            const RigidTransform& T_robot_camera_start,
                                            const PoseSearchSettings& settings,
                                            const SizeDemands& demands) {
  SizedPose pose = BestOfSizes(surfaces, clouds, T_robot_camera_start, settings);
  for (int k = 0; k < kCloudSizeTuning.fit_steps; ++k)
    Fit(surfaces, clouds, settings.narrowest_m, &pose);
  const std::vector<ThinCloud> shrunk = Shrunk(clouds, pose.scale);
  SizeComparison sizes;
  double squares_m2 = 0.0, count = 0.0, covered = 0.0;
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    const Pairs pairs =
        PairsOf(surfaces[f], clouds[f], pose, kCloudSizeTuning.reach * settings.narrowest_m);
    sizes.Add(pairs.points_m, pairs.feet_m);
    squares_m2 +=
        (pairs.here_m - pairs.feet_m).cwiseProduct(pairs.normals).colwise().sum().squaredNorm();
    count += static_cast<double>(pairs.here_m.cols());
    covered += ShareCovered(surfaces[f], shrunk[f], pose.T_robot_camera, settings.near_m);
  }
  const bool fits = covered > demands.least_cover * static_cast<double>(surfaces.size()) &&
                    squares_m2 < count * demands.most_rms_m * demands.most_rms_m;
  if (!fits || !sizes.Disagrees()) return std::nullopt;
  return sizes;
}

}  // namespace palpate::calibration
