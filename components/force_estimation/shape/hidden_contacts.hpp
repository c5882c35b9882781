// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <vector>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "components/force_estimation/shape/shape_fit.hpp"

namespace palpate::force_estimation {

/// Contacts that nobody sees, found where the fit leaves more than noise over, and found again
/// about the shape that they make, because the search is of first order only. Whatever does not
/// lead to a better fit is taken back.
class HiddenContacts {
 public:
  /// All must outlive this.
  HiddenContacts(robot::RobotModel& model, const ShapeConfig& config, ShapeFit& fit);

  bool prepared() const { return search_.prepared(); }
  /// About the fit's state, which must be one without contact.
  Status Prepare(const std::vector<robot::CableCommand>& cables);

  /// After a fit of the contacts that are known; later where the frame's work is used up.
  /// kBudgetReached: that was while hidden contacts were tried, on which the next frame decides;
  /// else not ok: the way back failed, too.
  Status Find(const ShapeFrame& frame, const DepthBias& bias);
  /// No site is hidden any more.
  void Forget();

 private:
  bool FindAgain(const ShapeFrame& frame, const DepthBias& bias, Status* status);
  bool IsTimeToSearch();
  Unexplained LeftOver() const;
  Unexplained WithoutHidden() const;
  Status Decide(const ShapeFrame& frame, const DepthBias& bias);
  bool Try(const std::vector<HiddenContact>& contacts, const ShapeFrame& frame,
           const DepthBias& bias, Status* status);
  bool AreWhereTheyWere(const std::vector<HiddenContact>& found) const;
  std::vector<Eigen::Vector3d> SeenPlaces() const;

  ShapeConfig config_;
  ShapeFit& fit_;
  HiddenSearch search_;
  int frames_since_search_ = 0;
  int pause_;  ///< between searches, frames
  /// What there was before the hidden contacts that are still being tried.
  std::optional<ShapeFit::Attempt> before_;
};

}  // namespace palpate::force_estimation
