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

/// The contacts that are being followed: those that perception sees come and go with it, those that
/// were found by search stay as long as their force shows.
class ContactTracks {
 public:
  ContactTracks(const robot::RobotModel& model, const ShapeConfig& config);

  /// Contacts of a new frame, mapped onto the skin in the shape `x_m` [3n]. A contact farther than
  /// kFarthest_m from the skin is left out, as are those beyond the number that can be fitted. A
  /// hidden site where a contact has come into view gives way to it; one that pushes and goes out
  /// of view becomes hidden: what is known of its force goes on. True where the set of places has
  /// changed.
  bool See(const std::vector<SeenContact>& contacts, const Eigen::VectorXd& x_m);

  /// The hidden sites become these, by the names that there are as far as they go.
  void ReplaceHidden(const std::vector<HiddenContact>& found);
  /// A hidden site is where the search says. False where that is less than kSmallestMove_m away.
  bool Follow(std::size_t index, const HiddenContact& found);
  /// An object that is seen beside a limb may push on the limb's other side: the site goes there
  /// along `force_N`, which pulls where it is, as far as it may lie from where it was seen. False
  /// where that is not so, or was done before.
  bool TurnOver(std::size_t index, const Eigen::Vector3d& force_N);
  /// The sites become what they were.
  void GoBack(const std::vector<ShapeSite>& sites) { sites_ = sites; }
  /// Moves a site along the undeformed surface. False where that is less than kSmallestMove_m.
  bool Move(std::size_t index, const Eigen::Vector3d& step_rest_m);
  /// What a frame's fit says of a site's force.
  enum class Evidence { kNone, kSignificant, kBeyondDoubt };
  /// Forces that are beyond doubt are believed after half of the frames; where a sequence `begins`,
  /// at once.
  void Judge(std::size_t index, Evidence evidence, bool quiet, bool begins = false);
  ForceFilter& filter(std::size_t index) { return sites_[index].filter; }
  void Forget() { sites_.clear(); }
  void ForgetHidden();
  /// Removes hidden sites that have been quiet for some frames. True where one was removed.
  bool ForgetQuiet();

  const std::vector<ShapeSite>& sites() const { return sites_; }
  bool full() const;

  static constexpr double kFarthest_m = 0.025;
  static constexpr double kSmallestMove_m = 3e-4;

 private:
  void Place(const SkinPoint& centre, ShapeSite* site) const;
  void AddHidden(const HiddenContact& found);
  void Refresh(const SeenContact& contact, ShapeSite* site);
  bool IsTaken(const SkinPoint& place, double sigma_m) const;
  double SigmaOf_m(const SeenContact& contact, const SkinPoint& place) const;
  bool PlaceAgainIfFar(ShapeSite* site) const;
  bool LoseSight(const std::vector<SeenContact>& contacts);
  ShapeSite NewSiteAt(const Eigen::Vector3d& rest_m) const;
  std::string HiddenName() { return "hidden_" + std::to_string(++hidden_names_); }
  bool DropHiddenNear(const Eigen::Vector3d& rest_m);
  ShapeSite* Find(const std::string& name);

  const robot::RobotModel& model_;
  ShapeConfig config_;
  SurfaceMap map_;
  std::vector<ShapeSite> sites_;
  int hidden_names_ = 0;
};

}  // namespace palpate::force_estimation
