// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/shape/camera_biases.hpp"
#include "components/force_estimation/shape/contact_tracks.hpp"
#include "components/force_estimation/shape/location_step.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "components/force_estimation/shape/shape_targets.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "components/force_estimation/shape/texture_motion.hpp"
#include "libs/core/index.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

struct ShapeFitterTuning {
  SurfaceMatchingTuning matching = {};
  ShapeTargetsTuning targets = {};
  ContactTracksTuning tracks = {};
  LocationStepTuning location = {};
  /// Matched surface points, below which no robot is seen. Fewer: shapes that the prior determines.
  int fewest_features = 6;
  /// Displacement of a surface point by the fit from which the frame is matched again. Smaller:
  /// more rounds.
  double match_again_m = 5e-4;
  /// Tolerance of a fit that may be matched again, in ShapeConfig::fit_tolerance. Larger: cheaper
  /// rounds, about a coarser shape.
  double rough_tolerances = 10.0;
  /// Step of a location after which the locations are estimated again in the same frame. Smaller:
  /// more rounds.
  double locate_again_m = 1e-3;
  double longest_step_m = 6e-3;  ///< of a location; longer: faster, may leave the linear range
  int location_rounds = 2;       ///< in a frame; more: slower, closer to the optimum
  /// Frames of a contact until its location is averaged: until then it moves by whole steps, then
  /// in one of so many frames by a share of the step. Larger share: faster, noisier locations.
  int frames_to_settle = 4;
  int frames_between_locations = 5;
  double settled_share = 0.3;
  /// Where the depth bias is fitted along: factor on the rounds of matching, and the change of a
  /// target by the bias after which forces are fitted again. More rounds, smaller: slower, closer
  /// to the joint optimum.
  int rounds_along = 3;
  double bias_again_m = 5e-5;
  int reweightings = 1;  ///< of outliers in a frame; more: slower, closer to the robust optimum
  /// Further fits where one has used up its iterations and the frame's work is not limited. More: a
  /// longer first frame, fewer failures far from the shape.
  int more_fits = 3;
  int most_continuation_steps = 3;  ///< the same; each takes seconds
  // Forces, of BodyScale::force_N.
  double longest_force_step_share = 0.016;  ///< of a Newton step; longer: faster, less robust
  double most_push_share = 5e-3;  ///< compression that cables tolerate while a fit converges
  double match_work = 1.0;        ///< of a matching, in substitutions; larger: fewer rounds
  /// Chord steps in a frame after which the factor is renewed. Fewer: more factorisations; more:
  /// slower convergence of the next frame.
  int aged_chord_steps = 4;
  /// A fit that was begun may exceed the frame's work by this factor, as a shape between two frames
  /// misleads all that follows. Larger: later frames; smaller: more unfinished ones.
  double fit_work_share = 4.0;
  /// Prior sigma of the tangential force, as a share of the largest friction. Larger: noise becomes
  /// tangential force.
  double friction_sigma = 0.5;
  /// Significance of a pull from which a contact is moved to the body's other side. Smaller: noise
  /// moves contacts.
  double adhesion_sigmas = 5.0;
  /// Lower bound of the normal force in the friction prior, of BodyScale::force_N. Larger: noisier
  /// tangential forces of weak contacts.
  double least_prior_force_share = 6.4e-3;
  /// Friction coefficient in the prior of hidden contacts, as in the search. Larger: a tangential
  /// force replaces a move to another location.
  double hidden_friction = 0.3;
  double least_hidden_force_share = 1.6e-3;  ///< as least_prior_force_share
  /// Of the normal force, likewise: practically uninformative.
  double normal_prior_sigma_share = 3.2;
};

/// Fits the model to the robot's shape in a frame: matches surface points, fits forces, and moves
/// contacts along the surface. The state goes on from frame to frame.
class ShapeFitter {
 public:
  /// All three must outlive this.
  ShapeFitter(robot::RobotModel& model, const Config& config, const ShapeConfig& shape,
              const ShapeFitterTuning& tuning = {});

  const BodyScale& scale() const { return scale_; }

  /// The initial shape, without contact forces.
  void StartAt(const fem::StaticState& state);
  bool started() const { return state_.valid; }
  void Stop() { state_.valid = false; }
  /// To be called after other code has used the model's linearisation.
  void ForgetFactor() { fitter_.ForgetFactor(); }

  /// Begins a frame; `whole`: without a limit of work.
  void BeginFrame(bool whole);
  /// Whether this frame's work is used up.
  bool IsWorkUsedUp() const { return budget_.Over(); }
  /// Whether work may be postponed to the next frame.
  bool IsWorkLimited() const { return limited_; }
  void AddWork(double work) { fitter_.AddWork(work); }

  /// Takes a frame's points of texture, and updates the tracks by the contacts that perception has
  /// located.
  void See(const ShapeFrame& frame);
  /// The same about the fitted shape; true where a contact has another location.
  bool SeeAgain(const ShapeFrame& frame);
  /// Matches the surface points about the present state. kNoRobotSeen where too few match.
  Status Match(const ShapeFrame& frame);
  /// Binds the texture of a contact-free frame to the present state.
  void LearnTexture(const ShapeFrame& frame) { texture_.Learn(frame, state_.x_m); }
  /// Matches and fits forces, in rounds, until the surface points are at rest. kBudgetReached: the
  /// state is valid and nearer, but the frame's work is used up.
  Status MatchAndFit(const ShapeFrame& frame, const CameraBiases& bias);
  /// The same where the shape may be far away, as with new contacts: in a frame without a limit of
  /// work it continues where iterations are used up or do not converge.
  Status MatchAndFitFromFar(const ShapeFrame& frame, const CameraBiases& bias);
  /// Moves contacts whose force is a significant pull to the body's other side, where they push, if
  /// their uncertainty allows it. True where one moved: the shape must be fitted again.
  bool FlipAdhesiveContacts();
  /// Moves the visible contacts by a Gauss-Newton step of the deformation, with their image
  /// location as prior: by all of it in their first frames, then by a share, which averages noise.
  Status Locate(const ShapeFrame& frame, const CameraBiases& bias);

  /// A state that can be restored.
  struct Attempt {
    std::vector<ShapeSite> sites;
    ModelState state;
    double chi_squared = 0.0;
  };
  /// Copies the state into `attempt`, whose memory is used again.
  void KeepIn(Attempt* attempt) const;
  void GoBack(const Attempt& attempt);
  /// Restores its shape, without contacts.
  void GoBackWithoutContacts(Attempt attempt);
  /// Removes a contact: the shape must be fitted again.
  void Remove(std::size_t site);
  /// Replaces the hidden sites; their forces begin at zero.
  void ReplaceHidden(const std::vector<HiddenContact>& found);

  /// From now on each matching fits this bias, whose map is unknown, along with the forces;
  /// nullptr: no longer. It must be the one that MatchAndFit gets.
  void FitAlong(CameraBiases* bias) { along_ = bias; }
  bool IsBiasFittedAlong() const { return along_ != nullptr; }
  /// Covariance of the forces [3k x 3k] of the last fit, N^2, with the share of a bias that was
  /// fitted along.
  Eigen::MatrixXd Covariance_N2() const;

  /// The shape to which the bias belongs: nodes [3n].
  void SetBiasShape(const Eigen::VectorXd& x_m) { bias_x_m_ = x_m; }

  const correspondence::SurfaceFeatures& features() const { return features_; }
  const std::vector<correspondence::FeatureMatch>& matches() const { return *matches_; }
  const ShapeTargets& targets() const { return targets_; }
  ContactTracks& tracks() { return tracks_; }
  const ContactTracks& tracks() const { return tracks_; }
  const std::vector<ShapeSite>& sites() const { return tracks_.sites(); }
  ForceNewton& fitter() { return fitter_; }
  const ForceNewton& fitter() const { return fitter_; }
  const ModelState& state() const { return state_; }
  const std::vector<LocatedForce>& located() const { return located_; }
  /// Motion of a site along the present surface for one along the undeformed surface [3 x 3],
  /// robot frame.
  Eigen::Matrix3d SurfaceGradientAt(std::size_t site) const;
  /// Mean square of residual over expected error, of the last fit; 1 where it fits.
  double Misfit() const;
  /// Of the model, since construction.
  int linearisations() const { return linearisations_; }
  /// Linearises at the fitted shape, where the next frame begins, if the frame took many chord
  /// steps. Returns whether it did; where that fails there is no factor.
  bool RenewAgedFactor();
  /// Fits after the locations of tracks have changed.
  Status FitAtNewLocations(const ShapeFrame& frame, const CameraBiases& bias);
  int TakeIterations() { return std::exchange(iterations_, 0); }

  Eigen::Vector3d ForceAt(std::size_t site) const {
    return state_.lambda_f_N.segment<3>(ToIndex(3 * site));
  }
  /// Unit, outward: mean normal of the contact's patch of surface in its present shape, as a
  /// contact at an edge touches both of its sides.
  Eigen::Vector3d NormalAt(std::size_t site) const;
  /// Prior sigma of a contact's tangential force, by friction.
  double TangentialSigma_N(std::size_t site) const;

 private:
  void UseSites();
  void SetForcePrior();
  int MatchingRounds() const;
  Eigen::MatrixXd SharedBias_m() const;  ///< [rows x parameters] derivative of the residuals
  double FitBiasAlong();                 ///< the largest change of a target, m
  Status FitRoughly(const ShapeFrame& frame);
  Status Fit(const ShapeFrame& frame);
  void CountSteps(const ForceFit& fit);
  /// Of the surface points since the nodes were there.
  double LargestMotion_m(const Eigen::VectorXd& from_x_m) const;
  bool IsTimeToLocate() const;
  /// The longest step that was made, m.
  double MoveSites();

  const robot::RobotModel& model_;
  ShapeConfig shape_;
  ShapeFitterTuning tuning_;
  correspondence::SurfaceFeatures features_;
  SurfaceMatching matching_;
  TextureMotion texture_;
  ShapeTargets targets_;
  BodyScale scale_;
  ContactTracks tracks_;
  ForceNewton fitter_;
  LocationStep location_;
  bool limited_ = false;
  fem::TimeBudget budget_;      ///< of work that can be postponed
  fem::TimeBudget fit_budget_;  ///< of fits that were begun
  ModelState state_;
  Eigen::VectorXd matched_x_m_;            ///< [3n] of the last matching
  Eigen::VectorXd bias_x_m_;               ///< [3n]; empty: the first initial shape
  std::vector<std::string> fitted_names_;  ///< of the fitter's sites
  CameraBiases* along_ = nullptr;
  CameraPoses poses_;          ///< of the last matching
  bool places_moved_ = false;  ///< since the fitter's last update
  const std::vector<correspondence::FeatureMatch>* matches_ = nullptr;
  std::vector<LocatedForce> located_;
  int iterations_ = 0;
  int linearisations_ = 0;
  int linearisations_before_frame_ = 0;
  int chord_steps_ = 0;  ///< in this frame
};

}  // namespace palpate::force_estimation
