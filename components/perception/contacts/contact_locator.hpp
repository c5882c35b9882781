// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/contact_config.hpp"
#include "components/perception/contacts/hidden_contact.hpp"
#include "components/perception/contacts/point_grid.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

/// Algorithm 2 of the paper: points of objects with more than n_neigh points of the robot within
/// r_search touch it; touching points that lie together are one contact.
///
/// An object mostly hides its contact from the camera, so r_search has to reach from its visible
/// rim to the robot. So that a contact is not smeared over all that lies within r_search, only
/// those points make its rim that are as near to the robot as any min_points about them, to the
/// resolution of the clouds: a pixel of the object that was taken for the robot makes no rim. A
/// mean of what is seen would lie before the contact by most of the object's radius:
/// - where the object is round next to its rim, the contact is where its hidden side meets the
///   robot's surface, be that in view or not (FindHiddenContact), or there is none where it does
///   not;
/// - else, where the robot's surface is known, it is on that part of it near the rim that is out of
///   view (FindHiddenSurface), and as uncertain as that part is large;
/// - else it is at the mean of the robot's points nearest to the rim. Its covariance then has three
///   parts: depth noise along the view rays; the gap between rim and robot and the resolution of
///   the clouds; and the hidden part: where the rim is an arc of radius a about the contact's
///   middle, its points spread by a^2 / 2 along the chord and lie 2 a / pi before the middle, so
///   that 0.8 (trace(S) I - S) of their scatter S holds that offset, and little along the chord.
class ContactLocator {
 public:
  /// The settings, or what was derived for the last clouds where they are 0.
  struct Thresholds {
    double r_search_m = 0.0;
    int n_neigh = 0;
    double cluster_distance_m = 0.0;
    double noise_m = 0.0;       ///< sigma of a distance between the clouds along the view ray
    double resolution_m = 0.0;  ///< to which distances between the clouds are known
  };

  explicit ContactLocator(const ContactConfig& config) : config_(config) {}

  /// Contacts without names, those of most points first. Camera frame, z > 0. `surface`: where the
  /// robot's surface is known to be, all round it; then contacts are found on the sides that the
  /// camera does not see, and round objects that are so large that they hide all of the robot
  /// within r_search. Holds until the next call.
  const std::vector<DetectedContact>& Locate(const rgbd::SensedCloud& robot,
                                             const rgbd::SensedCloud& object,
                                             const PredictedSurface* surface = nullptr);

  const Thresholds& thresholds() const { return thresholds_; }

 private:
  /// A point of the object's cloud near the robot.
  struct Touch {
    int object = 0;           ///< its number
    int robot = 0;            ///< that of the robot's point nearest to it
    float distance_m = 0.0f;  ///< between them
  };

  void Derive(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object);
  void FindTouching(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object);
  void KeepNearest(const rgbd::SensedCloud& object);
  void Gather(const rgbd::SensedCloud& object);
  void Cluster(const Eigen::Matrix3Xf& points_m, double link_m);
  void LocateLarge(const rgbd::SensedCloud& object, const PredictedSurface& surface);
  DetectedContact Summarise(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object,
                            const std::vector<int>& members) const;
  /// False where the object's far side does not reach the robot.
  bool LookBehind(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object,
                  const std::vector<int>& members, const PredictedSurface* surface,
                  DetectedContact* contact) const;
  void PlaceOnHiddenSurface(const rgbd::SensedCloud& robot, const std::vector<int>& members,
                            const PredictedSurface& surface, DetectedContact* contact) const;
  Eigen::Vector3d RimOf(const std::vector<int>& members) const;
  Resolution Known() const;

  ContactConfig config_;
  Thresholds thresholds_;
  PointGrid grid_;
  std::vector<Touch> touching_;
  Eigen::Matrix3Xf touching_m_;  ///< [3 x touching] of the object
  std::vector<float> sigma_m_;
  std::vector<std::vector<int>> clusters_;  ///< numbers in what was clustered
  std::vector<char> taken_;
  std::vector<char> in_contact_;  ///< [object] of a contact that was located
  std::vector<DetectedContact> contacts_;
};

}  // namespace palpate::perception
