// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/fit/force_fitter.hpp"
#include "components/force_estimation/shape/contact_tracks.hpp"
#include "components/force_estimation/shape/depth_bias.hpp"
#include "components/force_estimation/shape/location_step.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/shape_targets.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Moves the model to the robot's shape in a frame: features matched, forces fitted, contacts moved
/// along the surface. The state goes on from frame to frame.
class ShapeFitter {
 public:
  /// All three must outlive this.
  ShapeFitter(robot::RobotModel& model, const Config& config, const ShapeConfig& shape);

  /// A shape without contact forces to go on from.
  void StartAt(const fem::StaticState& state);
  bool started() const { return state_.valid; }
  void Stop() { state_.valid = false; }

  /// A new frame's work begins, `whole`: whatever it takes.
  void BeginFrame(bool whole);
  /// Whether nothing more should be begun in this frame.
  bool IsWorkUsedUp() const { return budget_.Over(); }
  /// Whether anything may be left to the next frame.
  bool IsWorkLimited() const { return limited_; }
  void AddWork(double work) { fitter_.AddWork(work); }

  /// Takes the contacts that perception has located.
  void See(const ShapeFrame& frame);
  /// The same about the shape that a fit has found; true where a contact has another place.
  bool SeeAgain(const ShapeFrame& frame);
  /// Matches the features about the present state. kNoRobotSeen where too few match.
  Status Match(const ShapeFrame& frame);
  /// Matches and fits forces, in rounds, until the features stay where they are. kBudgetReached:
  /// the state is sound, and nearer, but the frame's work is used up.
  Status MatchAndFit(const ShapeFrame& frame, const DepthBias& bias);
  /// The same where the shape may be far away, as with contacts that are new: in a frame that has
  /// the time it goes on where steps are used up, or lead nowhere.
  Status MatchAndFitFromFar(const ShapeFrame& frame, const DepthBias& bias);
  /// Contacts that seem to pull go to the body's other side, where they push, if they may be there.
  /// True where one did: the shape is to be fitted again.
  bool FlipAdhesiveContacts();
  /// Moves the contacts to where the deformation, and where they were seen, ask for: all the way in
  /// their first frames, then by a share of it, so that noise is averaged.
  Status Locate(const ShapeFrame& frame, const DepthBias& bias);

  /// What may be tried and taken back.
  struct Attempt {
    std::vector<ShapeSite> sites;
    ModelState state;
    double chi_squared = 0.0;
  };
  /// Into memory that is kept.
  void KeepIn(Attempt* attempt) const;
  void GoBack(const Attempt& attempt);
  /// To its shape, with no contact.
  void GoBackWithoutContacts(Attempt attempt);
  /// Other hidden sites than there were, without forces to begin with.
  void ReplaceHidden(const std::vector<HiddenContact>& found);

  /// The shape to which the bias belongs: nodes [3n].
  void LearntAt(const Eigen::VectorXd& x_m) { learnt_x_m_ = x_m; }

  const correspondence::SurfaceFeatures& features() const { return features_; }
  const std::vector<correspondence::FeatureMatch>& matches() const { return *matches_; }
  const ShapeTargets& targets() const { return targets_; }
  ContactTracks& book() { return book_; }
  const ContactTracks& book() const { return book_; }
  const std::vector<ShapeSite>& sites() const { return book_.sites(); }
  ForceFitter& fitter() { return fitter_; }
  const ForceFitter& fitter() const { return fitter_; }
  const ModelState& state() const { return state_; }
  const std::vector<LocatedForce>& located() const { return located_; }
  /// Mean square of residual over expected error, of the last fit; 1 where it fits.
  double Misfit() const;
  /// Of the model, since it was made.
  int linearisations() const { return linearisations_; }
  /// Linearises at the shape that was fitted, where the steps of the frame say that the factor has
  /// aged: the next frame begins there. Whether it did; where that fails there is no factor.
  bool RenewAgedFactor();
  /// Takes places that the book has changed, and fits about them.
  Status FitAtNewPlaces(const ShapeFrame& frame, const DepthBias& bias);
  int TakeIterations() { return std::exchange(iterations_, 0); }

  Eigen::Vector3d ForceAt(std::size_t site) const {
    return state_.lambda_f_N.segment<3>(static_cast<Eigen::Index>(3 * site));
  }
  /// Unit, outward, of the contact's patch of skin in its present shape: what presses on an edge
  /// touches both of its sides.
  Eigen::Vector3d NormalAt(std::size_t site) const;
  /// Of a contact's force along the surface, before it is seen: what friction allows.
  double TangentialSigma_N(std::size_t site) const;

 private:
  void UseSites();
  void SetForcePrior();
  Status FitRoughly(const ShapeFrame& frame);
  Status Fit(const ShapeFrame& frame);
  void CountSteps(const ForceFit& fit);
  /// Of the features since the nodes were there.
  double LargestMotion_m(const Eigen::VectorXd& from_x_m) const;
  bool IsTimeToLocate() const;
  /// The longest step that was made, m.
  double MoveSites();

  ShapeConfig shape_;
  correspondence::SurfaceFeatures features_;
  SurfaceMatching matching_;
  ShapeTargets targets_;
  ContactTracks book_;
  ForceFitter fitter_;
  LocationStep location_;
  bool limited_ = false;
  fem::TimeBudget budget_;      ///< for what can wait
  fem::TimeBudget fit_budget_;  ///< for what was begun
  ModelState state_;
  Eigen::VectorXd matched_x_m_;            ///< [3n] where the features were matched last
  Eigen::VectorXd learnt_x_m_;             ///< [3n]; empty: the first shape that was started at
  std::vector<std::string> fitted_names_;  ///< of the sites that the fitter has
  bool places_moved_ = false;              ///< since the fitter took them
  const std::vector<correspondence::FeatureMatch>* matches_ = nullptr;
  std::vector<LocatedForce> located_;
  int iterations_ = 0;
  int linearisations_ = 0;
  int linearisations_before_frame_ = 0;
  int chord_steps_ = 0;  ///< in this frame
};

}  // namespace palpate::force_estimation
