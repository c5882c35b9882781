// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/background_planes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace palpate::perception {

namespace {

using Points = std::vector<Eigen::Vector3f>;

Plane Facing(const Eigen::Vector3f& normal, const Eigen::Vector3f& point_m) {
  const float offset_m = normal.dot(point_m);
  if (offset_m > 0.0f) return {-normal, -offset_m};  // the camera is at the origin
  return {normal, offset_m};
}

bool IsOn(const Plane& plane, const Eigen::Vector3f& point_m,
          const BackgroundPlanes::Tolerance& tolerance) {
  return std::abs(plane.Height_m(point_m)) < tolerance.At(point_m.z());
}

/// Spread in the two directions in which a flat set of points is widest, 4 sigma (of even spread
/// 1.15 times the full size).
Eigen::Vector2f ExtentOf(const Eigen::Matrix3f& covariance_m2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(covariance_m2, Eigen::EigenvaluesOnly);
  return 4.0f * axes.eigenvalues().tail<2>().cwiseMax(0.0f).cwiseSqrt();
}

struct Moments {
  void Add(const Eigen::Vector3f& point_m) {
    const Eigen::Vector3d p = point_m.cast<double>();
    ++count;
    sum += p;
    products += p * p.transpose();
  }
  Eigen::Vector3f Mean() const { return (sum / static_cast<double>(count)).cast<float>(); }
  Eigen::Matrix3f Covariance() const {
    const Eigen::Vector3d mean = sum / static_cast<double>(count);
    return (products / static_cast<double>(count) - mean * mean.transpose()).cast<float>();
  }
  std::size_t count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
};

/// Numbers that are the same in every run (Knuth's MMIX).
class Draw {
 public:
  std::size_t Below(std::size_t end) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33) % end);
  }

 private:
  std::uint64_t state_ = 1;
};

bool IsBehindRobot(const Plane& plane, const Points& robot_m,
                   const BackgroundPlanesTuning& tuning) {
  std::size_t behind = 0;
  for (const Eigen::Vector3f& point_m : robot_m) {
    behind += plane.Height_m(point_m) < -tuning.behind_m ? 1 : 0;
  }
  return static_cast<double>(behind) <= tuning.most_behind * static_cast<double>(robot_m.size());
}

bool CarriesRobot(const Plane& plane, const Points& robot_m, const BackgroundPlanesTuning& tuning) {
  const auto is_foot = [&](const Eigen::Vector3f& point_m) {
    return std::abs(plane.Height_m(point_m)) < tuning.foot_m;
  };
  const auto feet = std::count_if(robot_m.begin(), robot_m.end(), is_foot);
  return !robot_m.empty() &&
         static_cast<double>(feet) >= tuning.least_feet * static_cast<double>(robot_m.size()) &&
         IsBehindRobot(plane, robot_m, tuning);
}

float SizeOf(const Points& robot_m, const BackgroundPlanesTuning& tuning) {
  if (robot_m.empty()) return tuning.least_extent_m;
  Moments moments;
  for (const Eigen::Vector3f& point_m : robot_m) moments.Add(point_m);
  return tuning.least_robot_sizes * ExtentOf(moments.Covariance()).y();
}

}  // namespace

void BackgroundPlanes::Update(const Points& points_m, const Points& robot_m,
                              const Tolerance& tolerance) {
  const float least_extent_m = SizeOf(robot_m, tuning_);
  const std::vector<Plane> known = planes_;
  planes_.clear();
  const bool search = --until_search_ < 0;
  if (search) until_search_ = tuning_.frames_between_searches;
  Points left_m = points_m;
  for (int k = 0; k < tuning_.most_planes && left_m.size() > tuning_.least_points; ++k) {
    const std::size_t least = std::max(
        tuning_.least_points,
        static_cast<std::size_t>(tuning_.least_share * static_cast<double>(left_m.size())));
    Plane plane;
    Moments held;
    const auto holds_enough = [&] {
      held = {};
      for (const Eigen::Vector3f& point_m : left_m) {
        if (IsOn(plane, point_m, tolerance)) held.Add(point_m);
      }
      if (held.count < least) return false;
      const float extent_m = ExtentOf(held.Covariance()).x();
      return extent_m >= least_extent_m || (extent_m >= tuning_.base_share * least_extent_m &&
                                            CarriesRobot(plane, robot_m, tuning_));
    };
    const bool is_known = planes_.size() < known.size();
    if (is_known) plane = known[planes_.size()];
    bool found = is_known && Refit(left_m, tolerance, &plane) && holds_enough();
    if (!found && (search || is_known)) found = Find(left_m, tolerance, &plane) && holds_enough();
    if (!found) break;
    if (IsBehindRobot(plane, robot_m, tuning_)) planes_.push_back(plane);
    std::erase_if(
        left_m, [&](const Eigen::Vector3f& p) { return plane.Height_m(p) < tolerance.At(p.z()); });
  }
}

bool BackgroundPlanes::Refit(const Points& points_m, const Tolerance& tolerance,
                             Plane* plane) const {
  Moments moments;
  for (const Eigen::Vector3f& point_m : points_m) {
    if (IsOn(*plane, point_m, tolerance)) moments.Add(point_m);
  }
  if (moments.count < tuning_.least_points) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(moments.Covariance());
  *plane = Facing(axes.eigenvectors().col(0), moments.Mean());
  return true;
}

/// RANSAC.
bool BackgroundPlanes::Find(const Points& points_m, const Tolerance& tolerance,
                            Plane* plane) const {
  Draw draw;
  std::size_t most = 0;
  for (int trial = 0; trial < tuning_.trials; ++trial) {
    const Eigen::Vector3f& a = points_m[draw.Below(points_m.size())];
    const Eigen::Vector3f& b = points_m[draw.Below(points_m.size())];
    const Eigen::Vector3f& c = points_m[draw.Below(points_m.size())];
    const Eigen::Vector3f across = (b - a).cross(c - a);
    if (across.norm() < 1e-4f) continue;
    const Plane candidate = Facing(across.normalized(), a);
    std::size_t count = 0;
    for (const Eigen::Vector3f& p : points_m) count += IsOn(candidate, p, tolerance) ? 1 : 0;
    if (count <= most) continue;
    most = count;
    *plane = candidate;
  }
  return most >= tuning_.least_points && Refit(points_m, tolerance, plane);
}

}  // namespace palpate::perception
