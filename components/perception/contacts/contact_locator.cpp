// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/contacts/contact_locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::perception {

namespace {

/// Of trace(S) I - S: (2 / pi)^2 over the half that a semicircle's points spread along the chord.
constexpr double kHiddenRim = 8.0 / (std::numbers::pi * std::numbers::pi);

double MedianSigma_m(const Eigen::VectorXf& sigma_m, std::vector<float>* buffer) {
  buffer->assign(sigma_m.begin(), sigma_m.end());
  return static_cast<double>(UpperMedian(*buffer));
}

}  // namespace

const std::vector<DetectedContact>& ContactLocator::Locate(const rgbd::SensedCloud& robot,
                                                           const rgbd::SensedCloud& object,
                                                           const PredictedSurface* surface) {
  contacts_.clear();
  if (robot.Count() == 0 || object.Count() == 0) return contacts_;
  Derive(robot, object);
  FindTouching(robot, object);
  KeepNearest(object);
  Cluster(touching_m_, thresholds_.cluster_distance_m);
  in_contact_.assign(static_cast<std::size_t>(object.Count()), 0);
  for (const std::vector<int>& members : clusters_) {
    if (static_cast<int>(members.size()) < config_.min_points) continue;
    DetectedContact contact = Summarise(robot, object, members);
    if (!LookBehind(robot, object, members, surface, &contact)) continue;
    contacts_.push_back(std::move(contact));
    for (const int k : members) {
      in_contact_[At(touching_[At(k)].object)] = 1;
    }
  }
  if (surface != nullptr) LocateLarge(object, *surface);
  std::sort(contacts_.begin(), contacts_.end(), [](const auto& a, const auto& b) {
    const auto key = [](const DetectedContact& c) {
      return std::tuple(-c.point_count, c.position_m.z(), c.position_m.x(), c.position_m.y());
    };
    return key(a) < key(b);
  });
  return contacts_;
}

void ContactLocator::Derive(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object) {
  const double robot_m = static_cast<double>(MedianSpacing_m(robot.points_m, &grid_));
  const double object_m = static_cast<double>(MedianSpacing_m(object.points_m, &grid_));
  const double noise_m =
      std::hypot(MedianSigma_m(robot.sigma_m, &sigma_m_), MedianSigma_m(object.sigma_m, &sigma_m_));
  thresholds_.noise_m = noise_m;
  const double rows_m = tuning_.rows * std::max(robot_m, object_m) + tuning_.sigmas * noise_m;
  thresholds_.resolution_m = 2.0 * (std::max(robot_m, object_m) + noise_m);
  thresholds_.r_search_m =
      config_.r_search_m > 0.0 ? config_.r_search_m : config_.hidden_depth_m + rows_m;
  thresholds_.cluster_distance_m =
      config_.cluster_distance_m > 0.0 ? config_.cluster_distance_m : 2.0 * rows_m;
  const double across = thresholds_.r_search_m / std::max(robot_m, 1e-6);
  const double half_disc = 0.5 * std::numbers::pi * across * across;
  const double derived =
      std::clamp(tuning_.half_disc_share * half_disc, tuning_.fewest_neighbours, 1000.0);
  thresholds_.n_neigh = config_.n_neigh > 0 ? config_.n_neigh : static_cast<int>(derived);
}

void ContactLocator::FindTouching(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object) {
  touching_.clear();
  const auto radius_m = static_cast<float>(thresholds_.r_search_m);
  grid_.Build(robot.points_m, radius_m);
  for (Eigen::Index i = 0; i < object.Count(); ++i) {
    int neighbours = 0;
    int nearest = 0;
    float nearest_m2 = std::numeric_limits<float>::infinity();
    grid_.ForEachNear(object.points_m.col(i), radius_m, [&](int other, float squared_m2) {
      ++neighbours;
      if (squared_m2 < nearest_m2) nearest = other;
      nearest_m2 = std::min(nearest_m2, squared_m2);
      return true;
    });
    if (neighbours <= thresholds_.n_neigh) continue;
    touching_.push_back({static_cast<int>(i), nearest, std::sqrt(nearest_m2)});
  }
}

void ContactLocator::KeepNearest(const rgbd::SensedCloud& object) {
  Gather(object);
  const auto radius_m = static_cast<float>(thresholds_.r_search_m);
  const auto resolution_m = static_cast<float>(thresholds_.resolution_m);
  grid_.Build(touching_m_, radius_m);
  std::size_t kept = 0;
  taken_.assign(touching_.size(), 0);
  for (std::size_t k = 0; k < touching_.size(); ++k) {
    const float limit_m = touching_[k].distance_m - resolution_m;
    int nearer = 0;
    grid_.ForEachNear(touching_m_.col(ToIndex(k)), radius_m, [&](int other, float) {
      nearer += touching_[At(other)].distance_m < limit_m ? 1 : 0;
      return nearer < config_.min_points;
    });
    taken_[k] = nearer < config_.min_points ? 0 : 1;
  }
  for (std::size_t k = 0; k < touching_.size(); ++k) {
    if (taken_[k] == 0) touching_[kept++] = touching_[k];
  }
  touching_.resize(kept);
  Gather(object);
}

void ContactLocator::Gather(const rgbd::SensedCloud& object) {
  touching_m_.resize(3, ToIndex(touching_.size()));
  for (std::size_t k = 0; k < touching_.size(); ++k) {
    touching_m_.col(ToIndex(k)) = object.points_m.col(touching_[k].object);
  }
}

void ContactLocator::Cluster(const Eigen::Matrix3Xf& points_m, double link_m) {
  clusters_.clear();
  const auto distance_m = static_cast<float>(link_m);
  grid_.Build(points_m, distance_m);
  taken_.assign(static_cast<std::size_t>(points_m.cols()), 0);
  for (std::size_t seed = 0; seed < taken_.size(); ++seed) {
    if (taken_[seed] != 0) continue;
    taken_[seed] = 1;
    std::vector<int>& members = clusters_.emplace_back(1, static_cast<int>(seed));
    for (std::size_t next = 0; next < members.size(); ++next) {
      grid_.ForEachNear(points_m.col(members[next]), distance_m, [&](int other, float) {
        char& taken = taken_[At(other)];
        if (taken == 0) members.push_back(other);
        taken = 1;
        return true;
      });
    }
  }
}

/// Objects with too few points near the visible part of the robot.
void ContactLocator::LocateLarge(const rgbd::SensedCloud& object, const PredictedSurface& surface) {
  Cluster(object.points_m, 0.5 * thresholds_.cluster_distance_m);
  for (const std::vector<int>& members : clusters_) {
    const auto is_located = [this](int k) { return in_contact_[At(k)] != 0; };
    if (std::any_of(members.begin(), members.end(), is_located)) continue;
    const Eigen::Matrix3Xd points_m = object.points_m(Eigen::all, members).cast<double>();
    const auto hidden = FindContactUnder(points_m, surface, thresholds_.noise_m, tuning_.hidden);
    if (!hidden) continue;
    DetectedContact& contact = contacts_.emplace_back();
    contact.point_count = static_cast<int>(members.size());
    contact.position_m = hidden->position_m;
    contact.covariance_m2 = hidden->covariance_m2;
    // Extent of the rim of a ball of this size, seen from the side.
    contact.extent_m.setConstant(hidden->radius_m);
  }
}

DetectedContact ContactLocator::Summarise(const rgbd::SensedCloud& robot,
                                          const rgbd::SensedCloud& object,
                                          const std::vector<int>& members) const {
  const auto count = static_cast<double>(members.size());
  const Eigen::Vector3d rim_m = RimOf(members);
  DetectedContact contact;
  contact.point_count = static_cast<int>(members.size());
  Eigen::Vector3f lower_m = touching_m_.col(members.front());
  Eigen::Vector3f upper_m = lower_m;
  Eigen::Matrix3d scatter_m2 = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d noise_m2 = Eigen::Matrix3d::Zero();
  for (const int k : members) {
    const Touch& touch = touching_[At(k)];
    contact.position_m += robot.points_m.col(touch.robot).cast<double>() / count;
    lower_m = lower_m.cwiseMin(touching_m_.col(k));
    upper_m = upper_m.cwiseMax(touching_m_.col(k));
    const Eigen::Vector3d point_m = touching_m_.col(k).cast<double>();
    PALPATE_CHECK(point_m.z() > 0.0, point_m.transpose());
    scatter_m2 += (point_m - rim_m) * (point_m - rim_m).transpose() / count;
    const auto sigma_z_m = static_cast<double>(object.sigma_m[touch.object]);
    const Eigen::Vector3d error_m = point_m * (sigma_z_m / (point_m.z() * count));
    noise_m2 += error_m * error_m.transpose();
  }
  contact.extent_m = (upper_m - lower_m).cast<double>();
  const Eigen::Vector3d gap_m = contact.position_m - rim_m;
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  contact.covariance_m2 = noise_m2 + kHiddenRim * (scatter_m2.trace() * identity - scatter_m2) +
                          tuning_.gap_variance * gap_m * gap_m.transpose() +
                          Known().Variance_m2() * identity;
  return contact;
}

Eigen::Vector3d ContactLocator::RimOf(const std::vector<int>& members) const {
  return touching_m_(Eigen::all, members).cast<double>().rowwise().mean();
}

Resolution ContactLocator::Known() const {
  return {.noise_m = thresholds_.noise_m, .resolution_m = thresholds_.resolution_m};
}

bool ContactLocator::LookBehind(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object,
                                const std::vector<int>& members, const PredictedSurface* surface,
                                DetectedContact* contact) const {
  const auto hidden =
      FindHiddenContact(robot, object, RimOf(members), surface, Known(), tuning_.hidden);
  if (!hidden) {
    if (surface != nullptr) PlaceOnHiddenSurface(robot, members, *surface, contact);
    return true;
  }
  contact->position_m = hidden->position_m;
  const double air_m = std::max(0.0, hidden->gap_m);
  contact->covariance_m2 =
      hidden->covariance_m2 + tuning_.gap_variance * air_m * air_m * Eigen::Matrix3d::Identity();
  return hidden->touches;
}

/// Assumes that the hidden part of the object extends over the width of its rim and the gap between
/// rim and robot.
void ContactLocator::PlaceOnHiddenSurface(const rgbd::SensedCloud& robot,
                                          const std::vector<int>& members,
                                          const PredictedSurface& surface,
                                          DetectedContact* contact) const {
  const Eigen::Matrix3Xd rim_m = touching_m_(Eigen::all, members).cast<double>();
  const Eigen::Vector3d middle_m = RimOf(members);
  const double width_m2 = 2.0 * (rim_m.colwise() - middle_m).colwise().squaredNorm().mean();
  const double air_m2 = (contact->position_m - middle_m).squaredNorm();
  const double known_m2 = thresholds_.resolution_m * thresholds_.resolution_m;
  const auto unseen =
      FindHiddenSurface(surface, robot, rim_m, std::sqrt(width_m2 + air_m2 + known_m2),
                        0.5 * thresholds_.resolution_m, tuning_.surface);
  if (!unseen) return;
  contact->position_m = unseen->middle_m;
  contact->covariance_m2 =
      unseen->covariance_m2 +
      (Known().Variance_m2() + tuning_.gap_variance * air_m2) * Eigen::Matrix3d::Identity();
}

}  // namespace palpate::perception
