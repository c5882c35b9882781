// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/shape_site.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

struct ContactTracksTuning {
  SurfaceMapTuning map = {};
  ForceFilterTuning filter = {};
  /// Lower bound of a visible contact's location sigma. Smaller: the location follows perception
  /// more closely than the deformation.
  double least_visible_sigma_m = 1e-3;
  /// Prior of hidden contacts, of BodyScale::length_m: no information.
  double hidden_sigma_share = 0.16;
  /// Of a contact that is no longer visible and may slide. Smaller: it is held where it was.
  double least_lost_sigma_m = 4e-3;
  /// Patch radius as a share of the visible extent, the rest of which is the object's rim. Larger:
  /// a wider pressure distribution.
  double patch_share_of_extent = 0.3;
  double largest_radius_m = 0.015;  ///< larger: contacts of wide objects have a wider patch
  /// A contact that becomes visible this close to a hidden one, of BodyScale::length_m, is the
  /// same. Larger: a second contact nearby inherits the force of the hidden one.
  double same_contact_share = 0.113;
  /// Visible contacts closer than this, or than these sigmas, are one. Smaller: two forces that are
  /// not identifiable are fitted.
  double one_contact_m = 0.01;
  double one_contact_sigmas = 2.0;
  /// Thickness of a limb at which a contact may be mapped to the wrong side while the model is not
  /// yet at the robot's shape. Larger: contacts on thick parts may flip, too.
  double thin_limb_m = 0.012;
  /// A track farther than this, or than these sigmas, from its visible location is placed again.
  /// Smaller: it follows perception's noise.
  double far_from_visible_m = 0.008;
  double far_sigmas = 3.0;
  /// Significant frames before a force is reported; hidden ones, which no image supports, need
  /// more. More: fewer false contacts, later reports.
  int frames_to_appear = 2;
  int frames_to_appear_hidden = 4;
  int quiet_frames_to_vanish = 3;  ///< more: contacts that have ended stay longer
  /// Visible contacts farther from the surface are left out. Larger: objects near the robot count
  /// as contacts.
  double farthest_m = 0.025;
  /// Shorter moves along the surface are left out. Smaller: more refits for noise.
  double least_move_m = 3e-4;
};

/// The contacts that are tracked: visible ones appear and vanish with perception, hidden ones stay
/// as long as their force is significant.
class ContactTracks {
 public:
  ContactTracks(const robot::RobotModel& model, const ShapeConfig& config,
                const ContactTracksTuning& tuning = {});

  /// Contacts of a new frame, mapped onto the surface in the shape `x_m` [3n]. Contacts too far
  /// from the surface, and beyond the number that can be fitted, are left out. A contact that
  /// becomes visible replaces a hidden one at its location. One that pushes and is no longer
  /// visible becomes hidden and keeps its force's history. True where the set of locations has
  /// changed.
  bool See(const std::vector<SeenContact>& contacts, const Eigen::VectorXd& x_m);

  /// Replaces the hidden sites; their names go on, in order.
  void ReplaceHidden(const std::vector<HiddenContact>& found);
  /// Moves a hidden site to the location of the search. False where that is nearer than
  /// least_move_m.
  bool Follow(std::size_t index, const HiddenContact& found);
  /// An object that is visible beside a limb may push on the limb's other side. Moves the site
  /// there along `force_N`, which pulls at the present location, within the location's uncertainty.
  /// False where there is no such side, or after a first move.
  bool TurnOver(std::size_t index, const Eigen::Vector3d& force_N);
  /// Restores the sites of an earlier state.
  void GoBack(const std::vector<ShapeSite>& sites) { sites_ = sites; }
  /// Moves a site along the undeformed surface. False for less than least_move_m.
  bool Move(std::size_t index, const Eigen::Vector3d& step_rest_m);
  /// Significance of a site's force in one frame.
  enum class Evidence { kNone, kSignificant, kBeyondDoubt };
  /// Counts a frame. Forces beyond doubt are reported after half of the frames; in the first frames
  /// of a sequence (`begins`) at once.
  void Judge(std::size_t index, Evidence evidence, bool quiet, bool begins = false);
  ForceFilter& filter(std::size_t index) { return sites_[index].filter; }
  void Forget() { sites_.clear(); }
  void ForgetHidden();
  /// Removes hidden sites that have been quiet for some frames. True where one was removed.
  bool ForgetQuiet();

  const std::vector<ShapeSite>& sites() const { return sites_; }
  bool full() const;

 private:
  bool IsSame(const ShapeSite& site, const Eigen::Vector3d& rest_m) const;
  void Place(const MaterialPoint& centre, ShapeSite* site) const;
  void AddHidden(const HiddenContact& found);
  void Refresh(const SeenContact& contact, ShapeSite* site);
  bool IsTaken(const MaterialPoint& place, double sigma_m) const;
  double SigmaOf_m(const SeenContact& contact, const MaterialPoint& place) const;
  bool PlaceAgainIfFar(ShapeSite* site) const;
  bool LoseSight(const std::vector<SeenContact>& contacts);
  ShapeSite NewSiteAt(const Eigen::Vector3d& rest_m) const;
  std::string HiddenName() { return "hidden_" + std::to_string(++hidden_names_); }
  bool DropHiddenNear(const Eigen::Vector3d& rest_m);
  ShapeSite* Find(const std::string& name);

  const robot::RobotModel& model_;
  ShapeConfig config_;
  ContactTracksTuning tuning_;
  double length_m_;  ///< of the robot
  SurfaceMap map_;
  std::vector<ShapeSite> sites_;
  int hidden_names_ = 0;
};

}  // namespace palpate::force_estimation
