// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/contact_config.hpp"
#include "components/perception/contacts/hidden_contact.hpp"
#include "components/perception/contacts/hidden_surface.hpp"
#include "components/perception/contacts/point_grid.hpp"
#include "components/perception/observation.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::perception {

struct ContactLocatorTuning {
  HiddenContactTuning hidden = {};
  HiddenSurfaceTuning surface = {};
  /// Spacings of the clouds between an object's rim and the robot: both are on one lattice of the
  /// image, and a row may be missing between them. Larger: objects near the robot count as
  /// contacts.
  double rows = 2.0;
  double sigmas = 3.0;  ///< of the noise, added to that distance; likewise
  /// n_neigh over the robot's points in half a disc of radius r_search, and its lower bound.
  /// Larger: fewer contacts at thin parts; smaller: contacts through single wrong pixels.
  double half_disc_share = 0.1;
  double fewest_neighbours = 2.0;
  /// Variance of the location across the gap between rim and robot, over the squared gap: one third
  /// for a uniform distribution. Larger: the force estimation may move the contact farther.
  double gap_variance = 1.0 / 3.0;
};

/// Algorithm 2 of the paper: points of objects with more than n_neigh points of the robot within
/// r_search touch it; touching points within cluster_distance of one another are one contact.
///
/// An object mostly occludes its contact, so that r_search extends from its visible rim to the
/// robot. A contact is not averaged over all points within r_search. Its rim are the points that
/// are as near to the robot as any min_points around them, to the resolution of the clouds: a
/// wrongly labelled pixel of the object makes no rim. The mean of the visible points is before the
/// contact by most of the object's radius:
/// - where the object is round next to its rim, the contact is where its hidden side meets the
///   robot's surface, visible or not (FindHiddenContact), or there is none where it does not;
/// - else, where the robot's surface is known, it is on the occluded part of it near the rim
///   (FindHiddenSurface), with a covariance of the size of that part;
/// - else it is at the mean of the robot's points nearest to the rim. Its covariance then has three
///   parts: depth noise along the view rays; the gap between rim and robot and the resolution of
///   the clouds; and the hidden part: where the rim is an arc of radius a about the contact's
///   centre, its points spread by a^2 / 2 along the chord and lie 2 a / pi before the centre, so
///   that 0.8 (trace(S) I - S) of their scatter S contains that offset, and little along the chord.
class ContactLocator {
 public:
  /// The settings; where they are 0, values derived from the last clouds.
  struct Thresholds {
    double r_search_m = 0.0;
    int n_neigh = 0;
    double cluster_distance_m = 0.0;
    double noise_m = 0.0;       ///< sigma of a distance between the clouds along the view ray
    double resolution_m = 0.0;  ///< of distances between the clouds
  };

  explicit ContactLocator(const ContactConfig& config, const ContactLocatorTuning& tuning = {})
      : config_(config), tuning_(tuning) {}

  /// Contacts without names, those of most points first. Camera frame, z > 0. `surface`: the
  /// robot's closed surface, where it is known; then contacts are found on occluded sides, and
  /// round objects so large that they hide all of the robot within r_search. Holds until the next
  /// call.
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
  /// False where the object's hidden side does not touch the robot.
  bool LookBehind(const rgbd::SensedCloud& robot, const rgbd::SensedCloud& object,
                  const std::vector<int>& members, const PredictedSurface* surface,
                  DetectedContact* contact) const;
  void PlaceOnHiddenSurface(const rgbd::SensedCloud& robot, const std::vector<int>& members,
                            const PredictedSurface& surface, DetectedContact* contact) const;
  Eigen::Vector3d RimOf(const std::vector<int>& members) const;
  Resolution Known() const;

  ContactConfig config_;
  ContactLocatorTuning tuning_;
  Thresholds thresholds_;
  PointGrid grid_;
  std::vector<Touch> touching_;
  Eigen::Matrix3Xf touching_m_;  ///< [3 x touching] of the object
  std::vector<float> sigma_m_;
  std::vector<std::vector<int>> clusters_;  ///< indices of the clustered points
  std::vector<char> taken_;
  std::vector<char> in_contact_;  ///< [object] of a contact that was located
  std::vector<DetectedContact> contacts_;
};

}  // namespace palpate::perception
