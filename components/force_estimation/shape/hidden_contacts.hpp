// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <vector>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "components/force_estimation/shape/shape_average.hpp"
#include "components/force_estimation/shape/shape_fitter.hpp"

namespace palpate::force_estimation {

/// Contacts that nobody sees, found where the fit leaves more than noise over. Whatever does not
/// lead to a better fit is taken back. Those that were found are followed: their places come from
/// responses about the present shape, from all frames in which they hold still, and from what was
/// known before.
class HiddenContacts {
 public:
  /// All must outlive this.
  HiddenContacts(robot::RobotModel& model, const ShapeConfig& config, ShapeFitter& fit);

  /// Patches that the search tries.
  int CandidateCount() const { return search_.CandidateCount(); }

  /// After a fit of the contacts that are known; later where the frame's work is used up.
  /// kBudgetReached: that was while hidden contacts were tried, on which the next frame decides;
  /// else not ok: the way back failed, too.
  Status Find(const ShapeFrame& frame, const DepthBias& bias);
  /// Solves for what the last Find left to the next one, if anything.
  void PrepareNext(const std::vector<robot::CableCommand>& cables);
  /// No site is hidden any more.
  void Forget();
  /// The same at the begin of a sequence, in which nothing was tried yet.
  void Begin();

 private:
  Status Search(const ShapeFrame& frame, const DepthBias& bias);
  Status Follow(const ShapeFrame& frame, const DepthBias& bias);
  Status FindOthers(const Unexplained& data, const ShapeFrame& frame, const DepthBias& bias);
  Status MoveTo(const std::vector<HiddenContact>& found, const ShapeFrame& frame,
                const DepthBias& bias);
  bool IsMuchLeft() const;
  bool IsTimeToSearch();
  bool IsTimeToFollow() const;
  bool LeavesToNextFrame();
  void Remember();
  Unexplained LeftOver() const;
  Unexplained OfHidden() const;
  Status Respond(const std::vector<robot::CableCommand>& cables);
  Status Decide(const ShapeFrame& frame, const DepthBias& bias);
  bool Try(const std::vector<HiddenContact>& contacts, const ShapeFrame& frame,
           const DepthBias& bias, Status* status);
  bool AreWhereTheyWere(const std::vector<HiddenContact>& found) const;
  std::vector<std::size_t> HiddenSites() const;
  std::vector<Eigen::Vector3d> SeenPlaces() const;

  std::vector<int> RowsOfTargets() const;

  ShapeConfig config_;
  robot::RobotModel& model_;
  ShapeFitter& fit_;
  HiddenSearch search_;
  int frames_since_search_ = 0;
  int pause_;  ///< between searches, frames
  ShapeAverage average_;
  int averaged_about_ = -1;         ///< linearisation
  std::vector<PlacePrior> priors_;  ///< of the hidden sites, from before the average began
  bool are_new_ = false;            ///< the hidden sites: nothing was known before
  bool left_over_ = false;          ///< by the last frame: what needs new responses
  int linearisations_ = -1;         ///< that the responses belong to
  ObservationJacobian responses_;
  std::vector<int> row_of_feature_;  ///< [features] of responses_; -1: none
  /// What there was before the hidden contacts that are still being tried.
  std::optional<ShapeFitter::Attempt> before_;
};

}  // namespace palpate::force_estimation
