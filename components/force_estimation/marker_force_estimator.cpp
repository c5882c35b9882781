// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/marker_force_estimator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "components/force_estimation/contact_search.hpp"
#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/marker_offset_calibration.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/robot/history_state.hpp"

namespace palpate::force_estimation {

namespace {

struct MarkerTuning {
  /// Largest distance of a given contact from the body's surface, m. Larger accepts places that are
  /// measured less well; smaller finds a wrong frame or unit sooner.
  double largest_contact_distance_m = 0.02;
  /// Variances below this share of the largest are of directions that were not fitted.
  double least_variance = 1e-12;
  /// Fits of a frame about the history variables of its own shape. Fewer: faster; more: truer while
  /// the robot moves.
  int most_rounds = 6;
};
constexpr MarkerTuning kMarkerTuning;

constexpr size_t kMostContacts = fem::kMaxQpVariables / 3;

/// F' C^-1 F in the directions that were fitted: the statistic of the test for a contact.
double SquaredDistanceFromZero(const ContactForce& contact) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(contact.covariance_N2);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double variance = eigen.eigenvalues()[k];
    if (variance <= kMarkerTuning.least_variance * eigen.eigenvalues()[2]) continue;
    const double component = eigen.eigenvectors().col(k).dot(contact.force_N);
    sum += component * component / variance;
  }
  return sum;
}

/// Of a frame without a force, where the fit has told its code alone.
Status WithReason(const Status& status) {
  if (!status.message().empty()) return status;
  switch (status.code()) {
    case StatusCode::kNotConverged:
      return {status.code(), "no forces were found that balance the model near the markers"};
    case StatusCode::kInverted:
      return {status.code(), "an element turns inside out on the way to the markers"};
    case StatusCode::kNotPositiveDefinite:
      return {status.code(), "the model is unstable near the markers"};
    case StatusCode::kUnobservable:
      return {status.code(), "the markers determine none of the forces"};
    default: return status;
  }
}

}  // namespace

class MarkerForceEstimator::Impl {
 public:
  Impl(robot::RobotModel& model, const Config& config, double modulus_sigma,
       fem::SecondsClock clock)
      : model_(model),
        config_(config),
        modulus_sigma_(modulus_sigma),
        clock_(std::move(clock)),
        sites_(ParseContactSites(config.contacts)),
        offsets_(model),
        history_(model),
        fitter_(model, config),
        free_state_(model.RestState()) {
    if (model.body().markers.empty()) throw InputError("the robot file names no markers");
    if (sites_.size() > kMostContacts) {
      throw InputError("contacts: " + std::to_string(sites_.size()) + " are given; at most " +
                       std::to_string(kMostContacts) + " are fitted at once");
    }
    for (const ContactSite& site : sites_) RefuseFarSite(site);
    if (sites_.empty()) search_.emplace(model, config, fitter_);
    SetSites(sites_);
    const auto rows = ToIndex(3 * model.body().markers.size());
    targets_.value_m = targets_.weight = shared_variance_m2_ = Eigen::VectorXd::Zero(rows);
    estimate_.marker_residual_m = Eigen::VectorXd::Zero(rows);
    estimate_.x_m = free_state_.x_m;
    estimate_.cables.resize(static_cast<size_t>(model.ActuatorCount()));
    withdrawn_.reserve(static_cast<size_t>(config.max_contacts) + sites_.size());
  }

  const ForceEstimate& Update(const MarkerFrame& frame) {
    estimate_.t_s = frame.t_s;
    estimate_.iterations = 0;
    estimate_.frame_error = 0.0;
    published_ = false;
    estimate_.status = WithReason(Process(frame));
    if (published_) CommitHistory();
    if (!published_) Withdraw();
    return estimate_;
  }

  MarkerMisfit Misfit();

  const std::vector<ContactSite>& sites() const { return sites_; }
  const ModelState& last_good() const { return fitter_.last_good(); }

 private:
  bool IsNear(const ContactSite& site) const;
  void RefuseFarSite(const ContactSite& site) const;
  void SetSites(const std::vector<ContactSite>& sites);
  Status FollowLoads(const MarkerFrame& frame);
  bool Searches() const { return sites_.empty(); }
  bool StandsOnContact(const robot::BodyMarker& marker) const;
  Status Process(const MarkerFrame& frame);
  Status FollowHistory(const MarkerFrame& frame);
  void FollowReference(const MarkerFrame& frame);
  void CommitHistory();
  Status CheckFrame(const MarkerFrame& frame) const;
  void SetPoseColumns(const MarkerFrame& frame);
  Status SetTargets(const MarkerFrame& frame);
  Status SolveFreeState(const MarkerFrame& frame);
  fem::TimeBudget FrameBudget() const;
  Status FitGivenSites(const MarkerFrame& frame);
  Status FitFromFreeState(const MarkerFrame& frame);
  Status Fit(const MarkerFrame& frame, const fem::TimeBudget& budget);
  Status StatusOfContacts() const;
  Status SearchSites(const MarkerFrame& frame);
  void Publish(const ForceFit& fit, const std::vector<FitSite>& fit_sites,
               const std::vector<ContactSite>& sites, double location_ci95_m);
  void PublishFit(const ForceFit& fit);
  void PublishState(const ModelState& state);
  void Withdraw();
  void HideContacts();
  double TangentialSigma_N(const ForceFit& fit, size_t site) const;
  ContactForce MakeContact(const ForceFit& fit, size_t index, double inflation) const;
  Eigen::MatrixXd ResponseOfSearched(const std::vector<FitSite>& sites);
  Eigen::MatrixXd ForcesOfPose_N(const ForceFit& fit, const std::vector<FitSite>& sites);

  robot::RobotModel& model_;
  Config config_;
  double modulus_sigma_;
  fem::SecondsClock clock_;
  std::vector<ContactSite> sites_;
  std::vector<FitSite> fit_sites_;
  std::vector<double> marker_weight_;
  MarkerOffsetCalibration offsets_;
  robot::HistoryState history_;
  ForceNewton fitter_;
  std::optional<ContactSearch> search_;  ///< where the settings give no contact
  RowTargets targets_;
  Eigen::VectorXd shared_variance_m2_;  ///< [3m] part of the variance that all frames share
  /// [3m x 6] the markers by the error of their pose, in its sigmas; empty: the pose is exact.
  Eigen::MatrixXd pose_columns_m_;
  bool pose_may_explain_ = false;  ///< that error moves a marker by more than its noise
  Eigen::MatrixXd by_pose_N_;      ///< [3k x 6] the forces by it
  double freedom_ = 0.0;           ///< coordinates used; those on a contact count as their weight
  fem::StaticState free_state_;    ///< last equilibrium without contact
  std::optional<std::vector<robot::ActuatorCommand>> free_inputs_;  ///< of free_state_
  ModelState state_;                                                ///< last fit
  ForceEstimate estimate_;
  std::vector<ContactForce> withdrawn_;  ///< keeps its memory for the next frame
  bool published_ = false;               ///< the estimate has a state of this frame
};

bool MarkerForceEstimator::Impl::IsNear(const ContactSite& site) const {
  return model_.Patch(site.position_m, site.patch_radius_m).distance_m <=
         kMarkerTuning.largest_contact_distance_m;
}

void MarkerForceEstimator::Impl::RefuseFarSite(const ContactSite& site) const {
  if (IsNear(site)) return;
  const fem::SurfacePatch patch = model_.Patch(site.position_m, site.patch_radius_m);
  throw InputError("contact '" + site.name + "' lies " + std::to_string(patch.distance_m) +
                   " m from the body's surface; at most " +
                   std::to_string(kMarkerTuning.largest_contact_distance_m) + " m is allowed");
}

/// The contacts of the frames from now on; none: they are searched.
void MarkerForceEstimator::Impl::SetSites(const std::vector<ContactSite>& sites) {
  sites_ = sites;
  fit_sites_.clear();
  for (const ContactSite& site : sites_) {
    fit_sites_.push_back(
        {.patch = model_.Patch(site.position_m, site.patch_radius_m), .direction = site.direction});
  }
  fitter_.SetSites(fit_sites_);
  marker_weight_.clear();
  for (const robot::BodyMarker& marker : model_.body().markers) {
    marker_weight_.push_back(StandsOnContact(marker) ? config_.contact_marker_weight : 1.0);
  }
  state_.valid = false;
}

/// Known loads are contacts of known place where the settings give no contact.
Status MarkerForceEstimator::Impl::FollowLoads(const MarkerFrame& frame) {
  if (!config_.contacts.empty() || frame.loads == sites_) return Status::Ok();
  for (const ContactSite& load : frame.loads) {
    if (!IsNear(load)) return {StatusCode::kInvalidInput, load.name + " is not on the body"};
  }
  if (frame.loads.size() > kMostContacts) {
    return {StatusCode::kInvalidInput, std::to_string(frame.loads.size()) +
                                           " known loads act at once; at most " +
                                           std::to_string(kMostContacts) + " contacts are fitted"};
  }
  SetSites(frame.loads);
  return Status::Ok();
}

bool MarkerForceEstimator::Impl::StandsOnContact(const robot::BodyMarker& marker) const {
  return std::any_of(sites_.begin(), sites_.end(), [&](const ContactSite& site) {
    return (marker.point.rest_m - site.position_m).norm() <=
           site.patch_radius_m + marker.point.distance_m;
  });
}

Status MarkerForceEstimator::Impl::Process(const MarkerFrame& frame) {
  if (Status status = CheckFrame(frame); !status.ok()) return status;
  if (frame.reference != ReferenceShape::kNone) {
    offsets_.Add(frame);
    FollowReference(frame);
    return {StatusCode::kNoCalibration, "reference frame: marker offsets are being set"};
  }
  if (Status status = offsets_.Finish(); !status.ok()) return status;
  if (Status status = FollowLoads(frame); !status.ok()) return status;
  if (Status status = SetTargets(frame); !status.ok()) return status;
  if (!history_.active()) return Searches() ? SearchSites(frame) : FitGivenSites(frame);
  return FollowHistory(frame);
}

/// Again until the history variables are those of the shape. A search does without: its cost would
/// be that of several.
Status MarkerForceEstimator::Impl::FollowHistory(const MarkerFrame& frame) {
  MarkerFrame as_driven = frame;
  as_driven.cables = history_.Prepare(frame.t_s, frame.cables);
  fitter_.ForgetFactor();
  free_inputs_.reset();
  if (Searches()) return SearchSites(as_driven);
  const fem::TimeBudget budget = FrameBudget();
  Status status = FitGivenSites(as_driven);
  for (int round = 1; round < kMarkerTuning.most_rounds && published_; ++round) {
    if (budget.Over() || !history_.Correct(estimate_.x_m)) break;
    fitter_.ForgetFactor();
    free_inputs_.reset();
    published_ = false;
    status = FitGivenSites(as_driven);
  }
  return status;
}

/// A body that is held in its undeformed shape relaxes there. One that is free is where its first
/// frame finds it.
void MarkerForceEstimator::Impl::FollowReference(const MarkerFrame& frame) {
  if (!history_.active()) return;
  history_.Prepare(frame.t_s, frame.cables);
  if (frame.reference != ReferenceShape::kUndeformed) return;
  history_.Commit(model_.elastic_body().rest_m(), Eigen::VectorXd::Zero(model_.ActuatorCount()));
}

void MarkerForceEstimator::Impl::CommitHistory() {
  if (!history_.active()) return;
  Eigen::VectorXd tension_N(model_.ActuatorCount());
  for (Eigen::Index c = 0; c < tension_N.size(); ++c)
    tension_N[c] = estimate_.cables[At(c)].tension_N;
  history_.Commit(estimate_.x_m, tension_N);
}

Status MarkerForceEstimator::Impl::CheckFrame(const MarkerFrame& frame) const {
  PALPATE_CHECK(frame.markers.size() == model_.body().markers.size(), frame.markers.size());
  PALPATE_CHECK(static_cast<int>(frame.cables.size()) == model_.ActuatorCount(),
                frame.cables.size());
  for (const robot::ActuatorCommand& command : frame.cables) {
    if (!std::isfinite(command.value)) {
      return {StatusCode::kInvalidInput, "an input of an actuator is not a finite number"};
    }
  }
  return Status::Ok();
}

void MarkerForceEstimator::Impl::SetPoseColumns(const MarkerFrame& frame) {
  if (frame.pose_error.IsZero()) {
    pose_columns_m_.resize(0, 0);
    return;
  }
  Eigen::Matrix3Xd seen_m = Eigen::Matrix3Xd::Zero(3, ToIndex(frame.markers.size()));
  for (size_t m = 0; m < frame.markers.size(); ++m) {
    const MarkerObservation& marker = frame.markers[m];
    if (marker.valid && marker.position_m.allFinite()) seen_m.col(ToIndex(m)) = marker.position_m;
  }
  pose_columns_m_ = PoseErrorColumns(frame.pose_error, seen_m, offsets_.reference_m());
}

Status MarkerForceEstimator::Impl::SetTargets(const MarkerFrame& frame) {
  SetPoseColumns(frame);
  pose_may_explain_ = false;
  targets_.rows = 0;
  freedom_ = 0.0;
  estimate_.noise_rms_m = 0.0;
  for (size_t m = 0; m < frame.markers.size(); ++m) {
    const MarkerObservation& marker = frame.markers[m];
    const auto row = ToIndex(3 * m);
    const bool used = marker.valid && marker.position_m.allFinite() && offsets_.Usable(m);
    const int reference_frames = offsets_.FrameCount(m);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double given = marker.sigma_m[i];
      const double noise = std::isfinite(given) && given > 0.0 ? given : config_.marker_sigma_m;
      const double offset_m2 = reference_frames > 0 ? noise * noise / reference_frames : 0.0;
      const double pose_m2 =
          pose_columns_m_.rows() > 0 ? pose_columns_m_.row(row + i).squaredNorm() : 0.0;
      pose_may_explain_ = pose_may_explain_ || (used && pose_m2 > noise * noise);
      shared_variance_m2_[row + i] =
          offset_m2 + pose_m2 + config_.marker_bias_m * config_.marker_bias_m;
      const double variance = noise * noise + shared_variance_m2_[row + i];
      targets_.weight[row + i] = used ? marker_weight_[m] / variance : 0.0;
      targets_.value_m[row + i] = used ? marker.position_m[i] - offsets_.offset_m()[row + i] : 0.0;
      if (!(targets_.weight[row + i] > 0.0)) continue;
      ++targets_.rows;
      freedom_ += marker_weight_[m];
      estimate_.noise_rms_m += variance;
    }
  }
  if (targets_.rows == 0) return {StatusCode::kNoRobotSeen, "no marker can be used"};
  estimate_.noise_rms_m = std::sqrt(estimate_.noise_rms_m / targets_.rows);
  return Status::Ok();
}

Status MarkerForceEstimator::Impl::SolveFreeState(const MarkerFrame& frame) {
  if (free_inputs_ == frame.cables) return Status::Ok();
  fitter_.ForgetFactor();
  free_inputs_.reset();
  Status status = model_.Solve(frame.cables, {}, &free_state_).status;
  if (status.ok()) free_inputs_ = frame.cables;
  return status;
}

fem::TimeBudget MarkerForceEstimator::Impl::FrameBudget() const {
  const bool limited = config_.frame_budget_s > 0.0;
  return fem::TimeBudget(limited ? config_.frame_budget_s : std::numeric_limits<double>::infinity(),
                         clock_);
}

/// Starts at the last frame's state; where that diverges, again at the equilibrium without contact.
Status MarkerForceEstimator::Impl::FitGivenSites(const MarkerFrame& frame) {
  const fem::TimeBudget budget = FrameBudget();
  Status status;
  if (state_.valid) {
    state_.balanced = false;
    status = Fit(frame, budget);
  }
  const bool diverged = !status.ok() && status.code() != StatusCode::kBudgetReached;
  // Without a state to start at the budget cannot be kept.
  if (diverged && !(state_.valid && budget.Over())) status = FitFromFreeState(frame);
  state_.valid = status.ok() || status.code() == StatusCode::kBudgetReached;
  if (!status.ok()) return status;
  PublishState(state_);
  Publish(fitter_.fit(), fit_sites_, sites_, 0.0);
  return StatusOfContacts();
}

Status MarkerForceEstimator::Impl::FitFromFreeState(const MarkerFrame& frame) {
  if (Status status = SolveFreeState(frame); !status.ok()) return status;
  state_.balanced = true;
  state_.x_m = free_state_.x_m;
  state_.lambda_a_N = free_state_.multipliers_N;
  state_.lambda_f_N = Eigen::VectorXd::Zero(3 * fitter_.SiteCount());
  return Fit(frame, {});
}

Status MarkerForceEstimator::Impl::Fit(const MarkerFrame& frame, const fem::TimeBudget& budget) {
  const ForceFit& fit = fitter_.Fit(targets_, frame.cables, &state_, budget);
  PublishFit(fit);
  return fit.status;
}

/// A frame may be used where one of its forces may, or where none acts.
Status MarkerForceEstimator::Impl::StatusOfContacts() const {
  bool none_acts = true;
  for (const ContactForce& contact : estimate_.contacts) {
    const StatusCode code = contact.status.code();
    if (code == StatusCode::kOk || code == StatusCode::kTangentialUnobservable ||
        code == StatusCode::kUncertain) {
      return Status::Ok();
    }
    none_acts = none_acts && code == StatusCode::kNoContact;
  }
  return {none_acts ? StatusCode::kNoContact : StatusCode::kUnobservable, {}};
}

Status MarkerForceEstimator::Impl::SearchSites(const MarkerFrame& frame) {
  if (Status status = SolveFreeState(frame); !status.ok()) return status;
  const ContactSearch::Result& found =
      search_->Find(targets_, shared_variance_m2_, frame.cables, free_state_);
  if (found.status.ok() || found.status.code() == StatusCode::kNoContact) {
    PublishState(found.state);
    PublishFit(found.fit);
  }
  HideContacts();
  if (found.status.ok()) {
    Publish(found.fit, found.fit_sites, found.sites, found.location_ci95_m);
    // The search weighs the markers one by one; an error that they share may explain what it found.
    if (pose_may_explain_) return StatusOfContacts();
  }
  return found.status;
}

void MarkerForceEstimator::Impl::PublishFit(const ForceFit& fit) {
  estimate_.iterations = fit.iterations;
  estimate_.frame_error = fit.error;
  estimate_.chi_squared = fit.chi_squared;
  estimate_.marker_residual_m = fit.residual_m;
  estimate_.residual_rms_m = fit.residual_m.norm() / std::sqrt(std::max(1, targets_.rows));
  estimate_.degrees_of_freedom = static_cast<int>(std::lround(freedom_)) -
                                 std::accumulate(fit.unknowns.begin(), fit.unknowns.end(), 0);
}

void MarkerForceEstimator::Impl::PublishState(const ModelState& state) {
  published_ = true;
  estimate_.x_m = state.x_m;
  for (int c = 0; c < model_.ActuatorCount(); ++c) {
    const robot::Actuator& actuator = model_.actuator(c);
    const double length = actuator.Value(state.x_m);
    estimate_.cables[At(c)] = {.length_m = length,
                               .displacement_m = actuator.rest_value_m() - length,
                               .tension_N = state.lambda_a_N[c]};
  }
}

/// A frame that failed must not show values of an earlier one.
void MarkerForceEstimator::Impl::Withdraw() {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  HideContacts();
  estimate_.residual_rms_m = estimate_.chi_squared = kUnknown;
  estimate_.degrees_of_freedom = 0;
  estimate_.marker_residual_m.setConstant(kUnknown);
  estimate_.x_m.setConstant(kUnknown);
  for (robot::ActuatorState& cable : estimate_.cables) cable = {kUnknown, kUnknown, kUnknown};
}

void MarkerForceEstimator::Impl::HideContacts() {
  if (!estimate_.contacts.empty()) withdrawn_.swap(estimate_.contacts);
  estimate_.contacts.clear();
}

MarkerMisfit MarkerForceEstimator::Impl::Misfit() {
  MarkerMisfit misfit{
      .residual_m = estimate_.marker_residual_m, .weight = targets_.weight, .response_m = {}};
  if (!published_) {
    misfit.weight.setZero();
    return misfit;
  }
  if (!Searches()) {
    misfit.response_m = fitter_.Response();
    return misfit;
  }
  std::vector<FitSite> sites = search_->result().fit_sites;
  sites.resize(estimate_.contacts.size());
  misfit.response_m = ResponseOfSearched(sites);
  if (!sites.empty() && misfit.response_m.size() == 0) misfit.weight.setZero();
  return misfit;
}

/// Response of the markers to the contacts that the search chose [3m x 3k], m/N: the fitter holds
/// the last ones that it tried. Empty where the state has no tangent.
Eigen::MatrixXd MarkerForceEstimator::Impl::ResponseOfSearched(const std::vector<FitSite>& sites) {
  const auto count = ToIndex(sites.size());
  Eigen::MatrixXd forces_N = Eigen::MatrixXd::Zero(estimate_.x_m.size(), 3 * count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const fem::InterpolationWeights& weights = sites[At(c)].patch.weights;
    for (size_t k = 0; k < weights.nodes.size(); ++k) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        forces_N(3 * weights.nodes[k] + i, 3 * c + i) += weights.weights[k];
      }
    }
  }
  Eigen::MatrixXd response_m;
  if (count > 0 && !fitter_.has_factor()) {  // the last candidate that was tried diverged
    fitter_.SetSites(sites);
    fitter_.RenewFactor(search_->result().state);
  }
  if (count > 0 && fitter_.has_factor()) {
    fitter_.RespondTo(forces_N, estimate_.x_m, &response_m);
  }
  return response_m;
}

/// What the fit makes of an error of the pose, which all markers share: S G' W times their motion
/// by it [3k x 6], with the covariance S of the forces and the markers' response G.
Eigen::MatrixXd MarkerForceEstimator::Impl::ForcesOfPose_N(const ForceFit& fit,
                                                           const std::vector<FitSite>& sites) {
  if (pose_columns_m_.rows() == 0 || sites.empty()) return {};
  const Eigen::MatrixXd response_m = Searches() ? ResponseOfSearched(sites) : fitter_.Response();
  if (response_m.size() == 0) return {};
  return fit.covariance_N2 * response_m.transpose() * targets_.weight.asDiagonal() *
         pose_columns_m_;
}

/// A residual beyond the noise is a sign of model error: the intervals are widened by the Birge
/// ratio, never narrowed.
void MarkerForceEstimator::Impl::Publish(const ForceFit& fit, const std::vector<FitSite>& fit_sites,
                                         const std::vector<ContactSite>& sites,
                                         double location_ci95_m) {
  const ModelState& state = Searches() ? search_->result().state : state_;
  const double inflation = estimate_.degrees_of_freedom > 0
                               ? std::max(1.0, fit.chi_squared / estimate_.degrees_of_freedom)
                               : 1.0;
  if (estimate_.contacts.empty()) estimate_.contacts.swap(withdrawn_);
  estimate_.contacts.resize(sites.size());
  by_pose_N_ = ForcesOfPose_N(fit, fit_sites);
  for (size_t s = 0; s < sites.size(); ++s) {
    ContactForce& contact = estimate_.contacts[s];
    contact = MakeContact(fit, s, inflation);
    contact.name = sites[s].name;
    contact.position_m = fit_sites[s].patch.weights.Position(state.x_m);
    contact.location_ci95_m = location_ci95_m;
    if (Searches()) {
      contact.location_covariance_m2 = search_->result().location_covariance_m2[s];
    }
  }
}

/// By friction, from the root mean square of the push: never zero, as the push is not known
/// exactly.
double MarkerForceEstimator::Impl::TangentialSigma_N(const ForceFit& fit, size_t site) const {
  const ModelState& state = Searches() ? search_->result().state : state_;
  const std::vector<FitSite>& sites = Searches() ? search_->result().fit_sites : fit_sites_;
  const auto row = ToIndex(3 * site);
  const Eigen::Vector3d normal = sites[site].patch.normal;
  const double push_N = normal.dot(state.lambda_f_N.segment<3>(row));
  const double variance_N2 = normal.dot(fit.covariance_N2.block<3, 3>(row, row) * normal);
  return config_.friction_sigma * std::sqrt(push_N * push_N + variance_N2);
}

ContactForce MarkerForceEstimator::Impl::MakeContact(const ForceFit& fit, size_t index,
                                                     double inflation) const {
  const ModelState& state = Searches() ? search_->result().state : state_;
  const auto row = ToIndex(3 * index);
  ContactForce contact;
  contact.force_N = state.lambda_f_N.segment<3>(row);
  const Eigen::Vector3d by_modulus = modulus_sigma_ * fit.modulus_sensitivity_N.segment<3>(row);
  contact.covariance_N2 =
      inflation * fit.covariance_N2.block<3, 3>(row, row) + by_modulus * by_modulus.transpose();
  if (by_pose_N_.rows() > 0) {
    const auto by_pose_N = by_pose_N_.middleRows<3>(row);
    contact.covariance_N2 += by_pose_N * by_pose_N.transpose();
  }
  switch (fit.observability[index]) {
    case Observability::kNone:
      contact.status = Status(StatusCode::kUnobservable, {});
      contact.force_N.setConstant(std::numeric_limits<double>::quiet_NaN());
      contact.covariance_N2.setConstant(std::numeric_limits<double>::quiet_NaN());
      contact.ci95_N = std::numeric_limits<double>::quiet_NaN();
      return contact;
    case Observability::kNormal:
      contact.status = Status(StatusCode::kTangentialUnobservable, {});
      break;
    case Observability::kFull: contact.status = Status::Ok(); break;
  }
  const int unknowns = fit.unknowns[index];
  const bool acts =
      SquaredDistanceFromZero(contact) > ChiSquaredQuantile(1.0 - config_.significance, unknowns);
  if (!acts) contact.status = Status(StatusCode::kNoContact, {});
  // Where nothing acts a location and friction have no meaning: the test is without them.
  if (Searches()) contact.covariance_N2 += search_->result().location_covariance_N2[index];
  contact.covariance_N2 +=
      UnfittedCovariance_N2(fit, index, [&](size_t site) { return TangentialSigma_N(fit, site); });
  SetInterval(config_.uncertain_share, &contact);
  return contact;
}

MarkerForceEstimator::MarkerForceEstimator(robot::RobotModel& model, const Config& config,
                                           double youngs_modulus_relative_sigma,
                                           fem::SecondsClock clock)
    : impl_(
          std::make_unique<Impl>(model, config, youngs_modulus_relative_sigma, std::move(clock))) {}

MarkerForceEstimator::~MarkerForceEstimator() = default;

const ForceEstimate& MarkerForceEstimator::Update(const MarkerFrame& frame) {
  return impl_->Update(frame);
}

MarkerMisfit MarkerForceEstimator::Misfit() { return impl_->Misfit(); }

const std::vector<ContactSite>& MarkerForceEstimator::sites() const { return impl_->sites(); }

const ModelState& MarkerForceEstimator::last_good() const { return impl_->last_good(); }

}  // namespace palpate::force_estimation
