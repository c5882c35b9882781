// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "components/force_estimation/shape/shape_average.hpp"
#include "components/force_estimation/shape/shape_fitter.hpp"

namespace palpate::force_estimation {

struct HiddenContactsTuning {
  HiddenSearchTuning search = {};
  ShapeAverageTuning average = {};
  int most_at_once = 2;  ///< contacts of one search, 1 or 2; 2: slower, finds pairs
  /// Radius around a visible contact that is not searched, of BodyScale::length_m: its own model
  /// error causes the residual there. Smaller: false hidden contacts beside visible ones.
  double taken_radius_share = 0.097;
  /// Relocations in one frame, each about a new shape. More: slower, closer to the optimum.
  int follow_rounds = 2;
  /// First frames of a hidden contact, each with a relocation; then one in so many. More, or a
  /// shorter interval: more work per frame, a location that follows faster.
  int young_frames = 5;
  int frames_between_locations = 5;
  /// Without a large misfit. Fewer: more work per frame, earlier detection of weak contacts.
  int frames_between_searches = 3;
  /// Failed attempts, which need many substitutions, double the interval up to this. Longer: less
  /// work on a misfit that no contact explains, later detection.
  int longest_pause_frames = 24;
  /// Mean square residual over noise from which a search begins at once. Smaller: more searches.
  double large_misfit = 1.5;
  /// Displacement of a hidden contact that counts as another location. Larger: wrong moves are kept
  /// although they fit worse.
  double same_location_m = 6e-3;
  /// Share of chi-squared that new hidden contacts must reach. Smaller: fewer false contacts.
  double better_misfit = 0.95;
  /// Attempts of one search, where the linearisation misleads and the frame's work is not limited.
  /// More: slower, fewer missed contacts.
  int most_tried = 4;
  double search_work = 1.0;  ///< of a search, in substitutions; larger: fewer searches in a frame
  double row_work = 0.1;     ///< of the response of a row, in substitutions; likewise
  /// Growth of a location's covariance when it becomes the prior of a new shape, with the slide of
  /// a contact meanwhile. Larger: the prior fades faster, with noisier locations.
  double prior_fading = 4.0;
  double slide_m = 1e-3;
  /// Model error as a share of the displacement, one sigma. Larger: less certain locations.
  double model_error = 0.015;
};

/// Hidden contacts, found where the fit leaves more residual than noise. Changes that do not
/// improve the fit are undone. Found contacts are tracked: their locations are estimated from
/// responses about the present shape, all frames in which they are at rest, and a prior from
/// earlier shapes.
class HiddenContacts {
 public:
  /// All must outlive this.
  HiddenContacts(robot::RobotModel& model, const ShapeConfig& config, ShapeFitter& fit,
                 const HiddenContactsTuning& tuning = {});

  /// Patches of the search.
  int CandidateCount() const { return search_.CandidateCount(); }

  /// After a fit of the known contacts; postponed where the frame's work is used up.
  /// kBudgetReached: an attempt is unfinished, and the next frame decides on it. Any other error:
  /// undoing an attempt failed, too.
  Status Find(const ShapeFrame& frame, const CameraBiases& bias);
  /// Solves for the responses that the last Find postponed, if any.
  void PrepareNext(const std::vector<robot::ActuatorCommand>& cables);
  /// The contacts of the last search were removed: the next one is later.
  void CountAsFailed();
  /// Removes all hidden sites.
  void Forget();
  /// The same at the begin of a sequence, without failed attempts.
  void Begin();

 private:
  Status Search(const ShapeFrame& frame, const CameraBiases& bias);
  Status Follow(const ShapeFrame& frame, const CameraBiases& bias);
  Status FindOthers(const Unexplained& data, const ShapeFrame& frame, const CameraBiases& bias);
  Status MoveTo(const std::vector<HiddenContact>& found, const ShapeFrame& frame,
                const CameraBiases& bias);
  bool IsMisfitLarge() const;
  bool IsTimeToSearch();
  bool IsTimeToFollow() const;
  bool LeavesToNextFrame();
  void AddToAverage();
  void AverageLeftOver(double t_s);
  Unexplained LeftOver() const;
  Unexplained OfHidden() const;
  Status Respond(const std::vector<robot::ActuatorCommand>& cables);
  Status Decide(const ShapeFrame& frame, const CameraBiases& bias);
  bool Try(const std::vector<HiddenContact>& contacts, const ShapeFrame& frame,
           const CameraBiases& bias, Status* status);
  bool AreWhereTheyWere(const std::vector<HiddenContact>& found) const;
  std::vector<std::size_t> HiddenSites() const;
  std::vector<Eigen::Vector3d> SeenPlaces() const;

  std::vector<int> RowsOfTargets() const;

  ShapeConfig config_;
  HiddenContactsTuning tuning_;
  robot::RobotModel& model_;
  ShapeFitter& fit_;
  HiddenSearch search_;
  double taken_radius_m_;
  int frames_since_search_ = 0;
  int pause_;  ///< between searches, frames
  ShapeAverage average_;
  int averaged_about_ = -1;                                         ///< number of the linearisation
  double averaged_t_s_ = -std::numeric_limits<double>::infinity();  ///< frame without hidden sites
  std::vector<PlacePrior> priors_;  ///< of the hidden sites, from before the average
  bool are_new_ = false;            ///< the hidden sites: without a prior
  bool left_over_ = false;          ///< the last frame postponed new responses
  int linearisations_ = -1;         ///< that the responses belong to
  ObservationJacobian responses_;
  std::vector<int> row_of_match_;  ///< [matches] of responses_; -1: none
  /// State before the unfinished attempt.
  std::optional<ShapeFitter::Attempt> before_;
};

}  // namespace palpate::force_estimation
