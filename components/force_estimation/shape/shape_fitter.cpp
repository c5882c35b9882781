// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::force_estimation {

namespace {

constexpr int kFewestFeatures = 6;
/// A frame is matched again where the fit has moved a feature by more.
constexpr double kMatchAgain_m = 5e-4;
/// How much coarser than to the end features are fitted that may have to be matched again.
constexpr double kRough = 10.0;
/// Places are looked for again in the same frame after a step longer than this.
constexpr double kLocateAgain_m = 1e-3;
constexpr double kLongestStep_m = 6e-3;
constexpr int kLocationRounds = 2;
constexpr int kFramesToSettle = 4;
constexpr int kFramesBetweenPlaces = 5;
constexpr double kSettledShare = 0.3;
constexpr int kReweightings = 1;
/// Fits that go on where one has used up its steps.
constexpr int kMoreFits = 3;
/// Continuing takes seconds.
constexpr int kMostContinuationSteps = 3;
constexpr double kLongestForceStep_N = 0.5;
constexpr double kMostPush_N = 0.15;
constexpr double kMatchWork = 1.0;
/// Chord steps of a frame by which its factor has aged.
constexpr int kStepsOfAgedFactor = 4;
/// A shape half way between two frames misleads all that looks at it: a fit that was begun may go
/// on beyond the work of a frame as far as this times it.
constexpr double kFitWorkShare = 4.0;
/// Standard deviation of the tangential force before it is seen, as a share of the largest
/// friction.
constexpr double kFrictionSigma = 0.5;
/// No noise: a force in the wrong direction by so many sigmas.
constexpr double kSurePull = 5.0;
constexpr double kSmallestPriorForce_N = 0.2;
/// Where a contact is not seen a tangential force looks like one at another place: what friction
/// usually is (that of the search).
constexpr double kHiddenFriction = 0.3;
constexpr double kSmallestHiddenForce_N = 0.05;
/// Of the force prior along the normal: none to speak of.
constexpr double kNormalPriorSigma_N = 100.0;

Config FitConfig(Config config, const ShapeConfig& shape) {
  config.frame_tolerance = shape.fit_tolerance;
  return config;
}

}  // namespace

ShapeFitter::ShapeFitter(robot::RobotModel& model, const Config& config, const ShapeConfig& shape)
    : shape_(shape),
      features_(model.body()),
      matching_(features_, shape),
      targets_(shape, config.contact_marker_weight),
      book_(model, shape),
      fitter_(model, FitConfig(config, shape)),
      location_{model, fitter_} {
  fitter_.KeepFactor(true);
  fitter_.TellModulusSensitivity(false);
  fitter_.LimitContinuationSteps(0);
  fitter_.TolerateCablesThatPush(kMostPush_N);
  fitter_.LimitForceStep(kLongestForceStep_N);
}

void ShapeFitter::BeginFrame(bool whole) {
  linearisations_before_frame_ = linearisations_;
  chord_steps_ = 0;
  limited_ = !whole && shape_.frame_work > 0.0;
  budget_ = fit_budget_ = {};
  if (!limited_) return;
  budget_ = fitter_.BudgetOfWork(shape_.frame_work);
  fit_budget_ = fitter_.BudgetOfWork(kFitWorkShare * shape_.frame_work);
}

void ShapeFitter::StartAt(const fem::StaticState& state) {
  fitter_.ForgetFactor();
  state_.valid = state_.balanced = true;
  state_.x_m = state.x_m;
  state_.lambda_a_N = state.multipliers_N;
  state_.lambda_f_N = Eigen::VectorXd::Zero(3 * fitter_.SiteCount());
  if (learnt_x_m_.size() == 0) learnt_x_m_ = state_.x_m;
}

void ShapeFitter::See(const ShapeFrame& frame) {
  places_moved_ = book_.See(frame.contacts, state_.x_m) || places_moved_;
  UseSites();
}

bool ShapeFitter::SeeAgain(const ShapeFrame& frame) {
  if (!book_.See(frame.contacts, state_.x_m)) return false;
  places_moved_ = true;
  UseSites();
  return true;
}

/// The fitter takes the book's sites; forces of those that stay are kept.
void ShapeFitter::UseSites() {
  const std::vector<ShapeSite>& sites = book_.sites();
  std::vector<FitSite> fit_sites;
  Eigen::VectorXd forces_N = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * sites.size()));
  std::vector<std::string> names;
  bool others = sites.size() != fitted_names_.size();
  for (std::size_t s = 0; s < sites.size(); ++s) {
    fit_sites.push_back({.patch = sites[s].patch});
    names.push_back(sites[s].name);
    const auto old = std::find(fitted_names_.begin(), fitted_names_.end(), sites[s].name);
    const auto index = old - fitted_names_.begin();
    others = others || index != static_cast<std::ptrdiff_t>(s);
    if (old != fitted_names_.end() && 3 * index + 3 <= state_.lambda_f_N.size()) {
      forces_N.segment<3>(static_cast<Eigen::Index>(3 * s)) =
          state_.lambda_f_N.segment<3>(3 * index);
    }
  }
  const bool moved = std::exchange(places_moved_, false);
  if (others) located_.clear();
  if (!others && !moved && state_.lambda_f_N.size() == forces_N.size()) return;
  fitted_names_ = std::move(names);
  fitter_.SetSites(fit_sites);
  state_.lambda_f_N = std::move(forces_N);
  state_.balanced = false;
}

/// A contact's force along the surface is no larger than friction allows; how large is not known.
void ShapeFitter::SetForcePrior() {
  const auto size = static_cast<Eigen::Index>(3 * sites().size());
  fem::QpMatrix information = fem::QpMatrix::Zero(size, size);
  for (std::size_t s = 0; s < sites().size(); ++s) {
    const auto row = static_cast<Eigen::Index>(3 * s);
    const Eigen::Vector3d normal = NormalAt(s);
    const double sigma_N = TangentialSigma_N(s);
    const Eigen::Matrix3d along = normal * normal.transpose();
    information.block<3, 3>(row, row) =
        (Eigen::Matrix3d::Identity() - along) / (sigma_N * sigma_N) +
        along / (kNormalPriorSigma_N * kNormalPriorSigma_N);
  }
  fitter_.SetForcePrior(information);
}

double ShapeFitter::TangentialSigma_N(std::size_t site) const {
  const double pressed_N = std::abs(NormalAt(site).dot(ForceAt(site)));
  const bool hidden = sites()[site].hidden;
  const double least_N = hidden ? kSmallestHiddenForce_N : kSmallestPriorForce_N;
  const double friction = hidden ? kHiddenFriction : kFrictionSigma * shape_.largest_friction;
  return std::max(1e-3, friction * std::max(pressed_N, least_N));
}

Eigen::Vector3d ShapeFitter::NormalAt(std::size_t site) const {
  Eigen::Vector3d area_m2 = Eigen::Vector3d::Zero();
  for (const int triangle : sites()[site].triangles) {
    Eigen::Vector3d corners[3];
    for (int i = 0; i < 3; ++i) {
      corners[i] = state_.x_m.segment<3>(3 * features_.triangles()(i, triangle));
    }
    area_m2 += (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  }
  return area_m2.normalized();
}

bool ShapeFitter::FlipAdhesiveContacts() {
  bool turned = false;
  for (std::size_t s = 0; s < sites().size(); ++s) {
    const Eigen::Vector3d normal = NormalAt(s);
    const auto row = static_cast<Eigen::Index>(3 * s);
    const Eigen::Matrix3d covariance_N2 = fitter_.fit().covariance_N2.block<3, 3>(row, row);
    const double sigma_N = std::sqrt(std::max(0.0, normal.dot(covariance_N2 * normal)));
    if (normal.dot(ForceAt(s)) < kSurePull * sigma_N) continue;
    turned = book_.TurnOver(s, ForceAt(s)) || turned;
  }
  if (!turned) return false;
  places_moved_ = true;
  located_.clear();
  UseSites();
  return true;
}

Status ShapeFitter::Match(const ShapeFrame& frame) {
  AddWork(kMatchWork);
  matches_ = &matching_.Match(frame, state_.x_m);
  const auto matched = std::count_if(matches_->begin(), matches_->end(), [](const auto& match) {
    return match.state == correspondence::MatchState::kMatched;
  });
  if (matched < kFewestFeatures) {
    return {StatusCode::kNoRobotSeen,
            "only " + std::to_string(matched) + " feature points are matched"};
  }
  return Status::Ok();
}

Status ShapeFitter::MatchAndFit(const ShapeFrame& frame, const DepthBias& bias) {
  Status status;
  for (int round = 0; round < shape_.matching_rounds; ++round) {
    if (status = Match(frame); !status.ok()) return status;
    targets_.Build(*matches_, bias, frame.T_robot_camera, state_.x_m, learnt_x_m_, sites());
    targets_.WeighAt(state_.x_m);
    fitter_.SetRows(targets_.rows());
    matched_x_m_ = state_.x_m;
    const bool last = round + 1 == shape_.matching_rounds;
    if (!last) {
      if (status = FitRoughly(frame); !status.ok()) return status;
      if (LargestMotion_m(matched_x_m_) >= kMatchAgain_m) continue;
    }
    return Fit(frame);
  }
  return status;
}

Status ShapeFitter::MatchAndFitFromFar(const ShapeFrame& frame, const DepthBias& bias) {
  if (limited_) return MatchAndFit(frame, bias);
  fitter_.LimitContinuationSteps(kMostContinuationSteps);
  Status status = MatchAndFit(frame, bias);
  for (int more = 0; status.code() == StatusCode::kBudgetReached && more < kMoreFits; ++more) {
    status = MatchAndFit(frame, bias);
  }
  fitter_.LimitContinuationSteps(0);
  return status;
}

double ShapeFitter::LargestMotion_m(const Eigen::VectorXd& from_x_m) const {
  double moved_m = 0.0;
  for (const robot::ObservationRow& row : targets_.rows()) {
    moved_m = std::max(moved_m, std::abs(row.Value(state_.x_m) - row.Value(from_x_m)));
  }
  return moved_m;
}

/// As far as tells whether the features must be matched anew.
Status ShapeFitter::FitRoughly(const ShapeFrame& frame) {
  fitter_.SetTolerance(kRough * shape_.fit_tolerance);
  SetForcePrior();
  const ForceFit& fit = fitter_.Fit(targets_.targets(), frame.cables, &state_, fit_budget_);
  fitter_.SetTolerance(shape_.fit_tolerance);
  CountSteps(fit);
  return fit.status;
}

/// With robust weights that go with the residual: one more fit where they have changed much.
Status ShapeFitter::Fit(const ShapeFrame& frame) {
  for (int k = 0;; ++k) {
    SetForcePrior();
    const ForceFit& fit = fitter_.Fit(targets_.targets(), frame.cables, &state_, fit_budget_);
    CountSteps(fit);
    if (!fit.status.ok()) return fit.status;
    if (!targets_.Reweight(fit.residual_m) || k == kReweightings) return Status::Ok();
  }
}

void ShapeFitter::CountSteps(const ForceFit& fit) {
  iterations_ += fit.iterations;
  linearisations_ += fit.iterations;
  chord_steps_ += fit.chord_steps;
}

bool ShapeFitter::RenewAgedFactor() {
  const bool in_frame = linearisations_ != linearisations_before_frame_;
  if (in_frame || chord_steps_ < kStepsOfAgedFactor) return false;
  ++linearisations_;
  fitter_.RenewFactor(state_);
  return true;
}

Status ShapeFitter::FitAtNewPlaces(const ShapeFrame& frame, const DepthBias& bias) {
  places_moved_ = true;
  UseSites();
  return MatchAndFit(frame, bias);
}

Status ShapeFitter::Locate(const ShapeFrame& frame, const DepthBias& bias) {
  const auto hidden = [](const ShapeSite& site) { return site.hidden; };
  if (std::all_of(sites().begin(), sites().end(), hidden)) {  // the search follows these
    located_.clear();
    return Status::Ok();
  }
  if (!IsTimeToLocate() && located_.size() == sites().size()) return Status::Ok();
  for (int round = 0; round < kLocationRounds; ++round) {
    if (!location_.Compute(sites(), targets_.targets(), state_, &located_).ok()) {
      located_.clear();
      return Status::Ok();  // the forces stand; where they act stays as it was
    }
    if (MoveSites() < kLocateAgain_m || !places_moved_) return Status::Ok();
    const std::vector<LocatedForce> located = located_;
    UseSites();
    if (Status status = MatchAndFit(frame, bias); !status.ok()) return status;
    located_ = located;
  }
  return Status::Ok();
}

double ShapeFitter::MoveSites() {
  double longest_m = 0.0;
  for (std::size_t s = 0; s < located_.size(); ++s) {
    const bool settled = sites()[s].frames >= kFramesToSettle;
    const double whole_m = located_[s].step_rest_m.norm();
    const double step_m = std::min(kLongestStep_m, (settled ? kSettledShare : 1.0) * whole_m);
    if (!(step_m > 0.0)) continue;
    longest_m = std::max(longest_m, step_m);
    places_moved_ = book_.Move(s, located_[s].step_rest_m * (step_m / whole_m)) || places_moved_;
  }
  return longest_m;
}

bool ShapeFitter::IsTimeToLocate() const {
  return std::any_of(sites().begin(), sites().end(), [](const ShapeSite& site) {
    return site.frames < kFramesToSettle || site.frames % kFramesBetweenPlaces == 0;
  });
}

double ShapeFitter::Misfit() const {
  return fitter_.fit().chi_squared / std::max(1, targets_.Count());
}

void ShapeFitter::KeepIn(Attempt* attempt) const {
  attempt->sites = book_.sites();
  attempt->state = state_;
  attempt->chi_squared = fitter_.fit().chi_squared;
}

void ShapeFitter::GoBack(const Attempt& attempt) {
  book_.GoBack(attempt.sites);
  places_moved_ = true;
  located_.clear();
  UseSites();
  state_ = attempt.state;
}

void ShapeFitter::GoBackWithoutContacts(Attempt attempt) {
  attempt.sites.clear();
  attempt.state.lambda_f_N.resize(0);
  GoBack(attempt);
}

/// Their forces begin at zero, from where the steps stay near equilibria; with those that were
/// found, in a shape that does not have them yet, they do not.
void ShapeFitter::ReplaceHidden(const std::vector<HiddenContact>& found) {
  book_.ReplaceHidden(found);
  places_moved_ = true;
  located_.clear();
  UseSites();
  for (std::size_t s = 0; s < sites().size(); ++s) {
    if (sites()[s].hidden) {
      state_.lambda_f_N.segment<3>(static_cast<Eigen::Index>(3 * s)).setZero();
    }
  }
}

}  // namespace palpate::force_estimation
