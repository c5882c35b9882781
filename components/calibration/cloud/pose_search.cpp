// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/pose_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::calibration {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A larger reach and more return points find poses from farther off, and cost time.
struct PoseSearchTuning {
  /// Weight of distances across the normal while the kernel is wide: point-to-plane distances alone
  /// let flat legs slide along themselves, larger weights slow the last steps.
  double across = 0.2;
  double reach = 3.0;  ///< in widths of the kernel, beyond which a pair has no weight
  /// Once the kernel has this share of its first width, a pose with less coverage is abandoned: a
  /// larger share or coverage saves time and loses poses that still converge.
  double halfway = 0.4;
  double hopeless = 0.45;
  Eigen::Index return_points = 250;   ///< surface points matched with the cloud, about
  Eigen::Index coverage_stride = 17;  ///< of surface points whose coverage is tested
  double arm_m = 0.1;                 ///< lever arm that compares turns with shifts
};
constexpr PoseSearchTuning kPoseSearchTuning;

Eigen::Vector3d MeanOf(const std::vector<ThinCloud>& clouds) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  Eigen::Index count = 0;
  for (const ThinCloud& cloud : clouds) {
    sum_m += cloud.points_m.rowwise().sum();
    count += cloud.Count();
  }
  return sum_m / static_cast<double>(std::max<Eigen::Index>(1, count));
}

/// Normal equations of a small rotation about `centre_m` and a translation, robot frame.
struct NormalEquations {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();

  /// A residual `off_m` along the unit `direction` of a point at `arm_m`.
  void Add(const Eigen::Vector3d& arm_m, const Eigen::Vector3d& direction, double off_m,
           double weight) {
    Vector6 row;
    row << arm_m.cross(direction), direction;
    matrix.noalias() += weight * row * row.transpose();
    right.noalias() += weight * off_m * row;
  }
};

/// Geman-McClure kernel of a point-to-plane distance: its width, and the weight across the normal.
struct Pull {
  double width_m;
  double across;

  void Add(const Eigen::Vector3d& arm_m, const Eigen::Vector3d& normal,
           const Eigen::Vector3d& off_m, double weight, NormalEquations* equations) const {
    const double root = 1.0 / (1.0 + off_m.squaredNorm() / (width_m * width_m));
    const double kernel = weight * root * root;
    equations->Add(arm_m, normal, normal.dot(off_m), kernel);
    for (int axis = 0; axis < 3; ++axis) {
      equations->Add(arm_m, Eigen::Vector3d::Unit(axis), off_m[axis], across * kernel);
    }
  }
};

void AddPulls(const SurfaceInView& surface, const ThinCloud& cloud,
              const geometry::RigidTransform& T_robot_camera, const Eigen::Vector3d& centre_m,
              const Pull& pull, NormalEquations* equations) {
  for (const auto& point : cloud.points_m.colwise()) {
    const Eigen::Vector3d here_m = T_robot_camera * point;
    const std::optional<SurfaceFoot> foot = surface.FootOf(here_m);
    if (!foot || foot->distance_m > kPoseSearchTuning.reach * pull.width_m) continue;
    pull.Add(here_m - centre_m, foot->normal, foot->position_m - here_m, 1.0, equations);
  }
}

/// The nearest point; its distance squared.
Eigen::Index Nearest(const Eigen::Matrix3Xd& points_m, const Eigen::Vector3d& place_m,
                     double* distance_squared_m2) {
  Eigen::Index nearest = 0;
  *distance_squared_m2 = (points_m.colwise() - place_m).colwise().squaredNorm().minCoeff(&nearest);
  return nearest;
}

/// Matches visible surface points with the nearest cloud points. Other objects count only where
/// they are nearer than the robot's points.
void AddReturnPulls(const SurfaceInView& surface, const ThinCloud& cloud,
                    const geometry::RigidTransform& T_robot_camera, const Eigen::Vector3d& centre_m,
                    const Pull& pull, double weight, NormalEquations* equations) {
  if (cloud.Count() == 0) return;
  const Eigen::Matrix3Xd points_m = T_robot_camera.Apply(cloud.points_m);
  const Eigen::Matrix3Xd& places_m = surface.seen_places_m();
  const double reach_m = kPoseSearchTuning.reach * pull.width_m;
  const Eigen::Index stride = 1 + places_m.cols() / kPoseSearchTuning.return_points;
  for (Eigen::Index k = 0; k < places_m.cols(); k += stride) {
    double squared_m2 = 0.0;
    const Eigen::Vector3d point_m = points_m.col(Nearest(points_m, places_m.col(k), &squared_m2));
    if (squared_m2 > reach_m * reach_m) continue;
    pull.Add(point_m - centre_m, surface.NormalAtSeenPlace(k), places_m.col(k) - point_m, weight,
             equations);
  }
}

/// One Gauss-Newton step. Returns its size: the displacement of a point at a typical arm, m.
double Step(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds,
            const Eigen::Vector3d& middle_camera_m, const Pull& pull, double return_weight,
            geometry::RigidTransform* T_robot_camera) {
  constexpr double kArm_m = kPoseSearchTuning.arm_m;
  const Eigen::Vector3d centre_m = *T_robot_camera * middle_camera_m;
  NormalEquations equations;
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    surfaces[f].LookFrom(*T_robot_camera);
    AddPulls(surfaces[f], clouds[f], *T_robot_camera, centre_m, pull, &equations);
    AddReturnPulls(surfaces[f], clouds[f], *T_robot_camera, centre_m, pull, return_weight,
                   &equations);
  }
  Vector6 ease;
  ease << Eigen::Vector3d::Constant(kArm_m * kArm_m), Eigen::Vector3d::Ones();
  equations.matrix.diagonal() += (1e-3 * equations.matrix(3, 3) + 1e-9) * ease;
  const Vector6 step =
      Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(equations.matrix).solve(equations.right);
  const Eigen::Vector3d turn_rad = step.head<3>();
  const double angle_rad = turn_rad.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle_rad > 0.0) turn = Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad);
  const Eigen::Vector3d from_centre_m = T_robot_camera->translation_m() - centre_m;
  *T_robot_camera = {turn * T_robot_camera->rotation(),
                     centre_m + turn * from_centre_m + step.tail<3>()};
  return step.tail<3>().norm() + kArm_m * angle_rad;
}

}  // namespace

ThinCloud Thin(const rgbd::SensedCloud& cloud, double spacing_m) {
  if (cloud.Count() == 0) return {};
  Eigen::VectorXf z_m = cloud.points_m.row(2);
  const double cell = spacing_m / static_cast<double>(UpperMedian(z_m));
  struct Nearest {
    Eigen::Index point;
    double off;
  };
  std::map<std::pair<int, int>, Nearest> of_cell;
  for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
    const Eigen::Vector3d point_m = cloud.points_m.col(k).cast<double>();
    const Eigen::Array2d place = point_m.head<2>().array() / (point_m.z() * cell);
    const Eigen::Array2d corner = place.floor();
    const double off = (place - corner - 0.5).matrix().squaredNorm();
    const std::pair key(static_cast<int>(corner.x()), static_cast<int>(corner.y()));
    const auto [at, is_new] = of_cell.try_emplace(key, Nearest{k, off});
    if (!is_new && off < at->second.off) at->second = {k, off};
  }
  ThinCloud thin;
  thin.points_m.resize(3, ToIndex(of_cell.size()));
  thin.sigma_m.resize(ToIndex(of_cell.size()));
  Eigen::Index n = 0;
  for (const auto& [key, nearest] : of_cell) {
    thin.points_m.col(n) = cloud.points_m.col(nearest.point).cast<double>();
    thin.sigma_m[n] = static_cast<double>(cloud.sigma_m[nearest.point]);
    ++n;
  }
  return thin;
}

namespace {

double MeanCovered(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds,
                   const geometry::RigidTransform& T_robot_camera, double near_m) {
  double sum = 0.0;
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    surfaces[f].LookFrom(T_robot_camera);
    sum += ShareCovered(surfaces[f], clouds[f], T_robot_camera, near_m);
  }
  return sum / static_cast<double>(surfaces.size());
}

PoseFit SearchFrom(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds,
                   const geometry::RigidTransform& start, const PoseSearchSettings& settings) {
  PoseFit fit{.T_robot_camera = start};
  const Eigen::Vector3d middle_m = MeanOf(clouds);
  double width_m = settings.widest_m;
  for (bool last = false; !last; width_m *= settings.shrink) {
    last = width_m <= settings.narrowest_m;
    width_m = std::max(width_m, settings.narrowest_m);
    const Pull pull{.width_m = width_m,
                    .across = kPoseSearchTuning.across * width_m / settings.widest_m};
    const double return_weight = last ? 0.0 : 1.0;
    for (int k = 0; k < settings.steps_each; ++k) {
      const double moved_m =
          Step(surfaces, clouds, middle_m, pull, return_weight, &fit.T_robot_camera);
      if (moved_m < settings.at_rest_m || settings.stop.stop_requested()) break;
    }
    if (width_m > kPoseSearchTuning.halfway * settings.widest_m) continue;
    fit.surface_covered = MeanCovered(surfaces, clouds, fit.T_robot_camera, settings.near_m);
    if (fit.surface_covered < kPoseSearchTuning.hopeless) return fit;
  }
  fit.surface_covered = MeanCovered(surfaces, clouds, fit.T_robot_camera, settings.near_m);
  return fit;
}

/// The initial pose, then rotated and translated about the cloud's centroid along camera axes.
std::vector<geometry::RigidTransform> StartsAround(const geometry::RigidTransform& start,
                                                   const Eigen::Vector3d& middle_camera_m,
                                                   const PoseSearchSettings& settings) {
  std::vector<geometry::RigidTransform> starts = {start};
  for (const double sign : {1.0, -1.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(sign * settings.around_rad, along));
      const Eigen::Vector3d shift_m = middle_camera_m - turn * middle_camera_m;
      starts.push_back(start * geometry::RigidTransform(turn, shift_m));
      starts.push_back(start * geometry::RigidTransform(Eigen::Quaterniond::Identity(),
                                                        sign * settings.around_m * along));
    }
  }
  return starts;
}

}  // namespace

PoseFit SearchPose(std::vector<SurfaceInView>& surfaces, const std::vector<ThinCloud>& clouds,
                   const geometry::RigidTransform& T_robot_camera_start,
                   const PoseSearchSettings& settings) {
  PoseFit best;
  int searched = 0;
  bool best_is_near = false;
  for (const geometry::RigidTransform& start :
       StartsAround(T_robot_camera_start, MeanOf(clouds), settings)) {
    PoseFit fit = SearchFrom(surfaces, clouds, start, settings);
    const bool near = IsNear(fit.T_robot_camera, T_robot_camera_start, clouds, settings);
    const bool covers_more = near == best_is_near && fit.surface_covered > best.surface_covered;
    if (searched == 0 || (near && !best_is_near) || covers_more) {
      best = fit;
      best_is_near = near;
    }
    best.starts = ++searched;
    if (best_is_near && best.surface_covered >= settings.good_cover) break;
    if (settings.stop.stop_requested()) break;
  }
  return best;
}

bool IsNear(const geometry::RigidTransform& T_robot_camera, const geometry::RigidTransform& start,
            const std::vector<ThinCloud>& clouds, const PoseSearchSettings& settings) {
  const Eigen::Vector3d middle_m = MeanOf(clouds);
  const double moved_m = (T_robot_camera * middle_m - start * middle_m).norm();
  const double turned_rad = T_robot_camera.rotation().angularDistance(start.rotation());
  return moved_m <= settings.farthest_m && turned_rad <= settings.farthest_rad;
}

double ShareCovered(const SurfaceInView& surface, const ThinCloud& cloud,
                    const geometry::RigidTransform& T_robot_camera, double near_m) {
  constexpr Eigen::Index kStride = kPoseSearchTuning.coverage_stride;
  const Eigen::Matrix3Xd points_m = T_robot_camera.Apply(cloud.points_m);
  const Eigen::Matrix3Xd& places_m = surface.seen_places_m();
  int count = 0, covered = 0;
  for (Eigen::Index k = 0; k < places_m.cols(); k += kStride, ++count) {
    if (points_m.cols() == 0) continue;
    double squared_m2 = 0.0;
    Nearest(points_m, places_m.col(k), &squared_m2);
    covered += squared_m2 <= near_m * near_m ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(covered) / count : 0.0;
}

}  // namespace palpate::calibration
