// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/shape_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::force_estimation {

namespace {

Config FitConfig(Config config, const ShapeConfig& shape) {
  config.frame_tolerance = shape.fit_tolerance;
  return config;
}

/// Two edges of a triangle, m.
using Edges = Eigen::Matrix<double, 3, 2>;

/// `nodes_m` [3 x n].
Edges EdgesOf(const Eigen::Vector3i& triangle, const Eigen::Ref<const Eigen::Matrix3Xd>& nodes_m) {
  Edges edges_m;
  edges_m << nodes_m.col(triangle[1]) - nodes_m.col(triangle[0]),
      nodes_m.col(triangle[2]) - nodes_m.col(triangle[0]);
  return edges_m;
}

Eigen::Map<const Eigen::Matrix3Xd> NodesOf(const Eigen::VectorXd& x_m) {
  return {x_m.data(), 3, x_m.size() / 3};
}

}  // namespace

ShapeFitter::ShapeFitter(robot::RobotModel& model, const Config& config, const ShapeConfig& shape,
                         const ShapeFitterTuning& tuning)
    : model_(model),
      shape_(shape),
      tuning_(tuning),
      features_(model.body()),
      matching_(features_, shape, tuning.matching),
      texture_(features_),
      targets_(shape, config.contact_marker_weight, tuning.targets),
      scale_(ScaleOf(model.body())),
      tracks_(model, shape, tuning.tracks),
      fitter_(model, FitConfig(config, shape)),
      location_{model, fitter_, tuning.location} {
  fitter_.KeepFactor(true);
  fitter_.TellModulusSensitivity(false);
  fitter_.LimitContinuationSteps(0);
  fitter_.TolerateCablesThatPush(tuning_.most_push_share * scale_.force_N);
  fitter_.LimitForceStep(tuning_.longest_force_step_share * scale_.force_N);
}

void ShapeFitter::BeginFrame(bool whole) {
  linearisations_before_frame_ = linearisations_;
  chord_steps_ = 0;
  limited_ = !whole && shape_.frame_work > 0.0;
  budget_ = fit_budget_ = {};
  if (!limited_) return;
  budget_ = fitter_.BudgetOfWork(shape_.frame_work);
  fit_budget_ = fitter_.BudgetOfWork(tuning_.fit_work_share * shape_.frame_work);
}

void ShapeFitter::StartAt(const fem::StaticState& state) {
  fitter_.ForgetFactor();
  state_.valid = state_.balanced = true;
  state_.x_m = state.x_m;
  state_.lambda_a_N = state.multipliers_N;
  state_.lambda_f_N = Eigen::VectorXd::Zero(3 * fitter_.SiteCount());
  if (bias_x_m_.size() == 0) bias_x_m_ = state_.x_m;
}

void ShapeFitter::See(const ShapeFrame& frame) {
  texture_.Match(frame);
  places_moved_ = tracks_.See(frame.contacts, state_.x_m) || places_moved_;
  UseSites();
}

bool ShapeFitter::SeeAgain(const ShapeFrame& frame) {
  if (!tracks_.See(frame.contacts, state_.x_m)) return false;
  places_moved_ = true;
  UseSites();
  return true;
}

/// Gives the tracked sites to the fitter; forces of sites that stay are kept.
void ShapeFitter::UseSites() {
  const std::vector<ShapeSite>& sites = tracks_.sites();
  std::vector<FitSite> fit_sites;
  Eigen::VectorXd forces_N = Eigen::VectorXd::Zero(ToIndex(3 * sites.size()));
  std::vector<std::string> names;
  bool others = sites.size() != fitted_names_.size();
  for (std::size_t s = 0; s < sites.size(); ++s) {
    fit_sites.push_back({.patch = sites[s].patch});
    names.push_back(sites[s].name);
    const auto old = std::find(fitted_names_.begin(), fitted_names_.end(), sites[s].name);
    const auto index = old - fitted_names_.begin();
    others = others || index != ToIndex(s);
    if (old != fitted_names_.end() && 3 * index + 3 <= state_.lambda_f_N.size()) {
      forces_N.segment<3>(ToIndex(3 * s)) = state_.lambda_f_N.segment<3>(3 * index);
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

/// Prior of a contact's tangential force: within friction, otherwise unknown.
void ShapeFitter::SetForcePrior() {
  const auto size = ToIndex(3 * sites().size());
  fem::QpMatrix information = fem::QpMatrix::Zero(size, size);
  const double normal_sigma_N = tuning_.normal_prior_sigma_share * scale_.force_N;
  for (std::size_t s = 0; s < sites().size(); ++s) {
    const auto row = ToIndex(3 * s);
    const Eigen::Vector3d normal = NormalAt(s);
    const double sigma_N = TangentialSigma_N(s);
    const Eigen::Matrix3d along = normal * normal.transpose();
    information.block<3, 3>(row, row) =
        (Eigen::Matrix3d::Identity() - along) / (sigma_N * sigma_N) +
        along / (normal_sigma_N * normal_sigma_N);
  }
  fitter_.SetForcePrior(information);
}

double ShapeFitter::TangentialSigma_N(std::size_t site) const {
  const double pressed_N = std::abs(NormalAt(site).dot(ForceAt(site)));
  const bool hidden = sites()[site].hidden;
  const double least_share =
      hidden ? tuning_.least_hidden_force_share : tuning_.least_prior_force_share;
  const double friction =
      hidden ? tuning_.hidden_friction : tuning_.friction_sigma * shape_.largest_friction;
  return std::max(1e-3, friction * std::max(pressed_N, least_share * scale_.force_N));
}

Eigen::Vector3d ShapeFitter::NormalAt(std::size_t site) const {
  Eigen::Vector3d area_m2 = Eigen::Vector3d::Zero();
  for (const int triangle : sites()[site].triangles) {
    const Edges edges_m = EdgesOf(features_.triangles().col(triangle), NodesOf(state_.x_m));
    area_m2 += edges_m.col(0).cross(edges_m.col(1));
  }
  return area_m2.normalized();
}

Eigen::Matrix3d ShapeFitter::SurfaceGradientAt(std::size_t site) const {
  const Eigen::Vector3i triangle = features_.triangles().col(sites()[site].centre.triangle);
  const Edges rest_m = EdgesOf(triangle, model_.body().mesh.nodes_m);
  const Eigen::Matrix2d metric_m2 = rest_m.transpose() * rest_m;
  return EdgesOf(triangle, NodesOf(state_.x_m)) * metric_m2.inverse() * rest_m.transpose();
}

bool ShapeFitter::FlipAdhesiveContacts() {
  bool moved = false;
  const Eigen::MatrixXd covariances_N2 = Covariance_N2();
  for (std::size_t s = 0; s < sites().size(); ++s) {
    const Eigen::Vector3d normal = NormalAt(s);
    const auto row = ToIndex(3 * s);
    const Eigen::Matrix3d covariance_N2 = covariances_N2.block<3, 3>(row, row);
    const double sigma_N = std::sqrt(std::max(0.0, normal.dot(covariance_N2 * normal)));
    if (normal.dot(ForceAt(s)) < tuning_.adhesion_sigmas * sigma_N) continue;
    moved = tracks_.TurnOver(s, ForceAt(s)) || moved;
  }
  if (!moved) return false;
  places_moved_ = true;
  located_.clear();
  UseSites();
  return true;
}

Status ShapeFitter::Match(const ShapeFrame& frame) {
  AddWork(tuning_.match_work);
  matches_ = &matching_.Match(frame, state_.x_m);
  const auto matched = std::count_if(matches_->begin(), matches_->end(), [](const auto& match) {
    return match.state == correspondence::MatchState::kMatched;
  });
  if (matched < tuning_.fewest_features) {
    return {StatusCode::kNoRobotSeen,
            "only " + std::to_string(matched) + " feature points are matched"};
  }
  return Status::Ok();
}

Status ShapeFitter::MatchAndFit(const ShapeFrame& frame, const CameraBiases& bias) {
  Status status;
  const int rounds = MatchingRounds();
  for (int round = 0; round < rounds; ++round) {
    if (status = Match(frame); !status.ok()) return status;
    poses_ = frame.Poses();
    targets_.Build(*matches_, texture_.matches(), bias, poses_, state_.x_m, bias_x_m_, sites());
    targets_.WeighAt(state_.x_m);
    fitter_.SetRows(targets_.rows());
    matched_x_m_ = state_.x_m;
    const bool last = round + 1 == rounds;
    if (!last) {
      if (status = FitRoughly(frame); !status.ok()) return status;
      const bool bias_changed = along_ != nullptr && FitBiasAlong() >= tuning_.bias_again_m;
      if (bias_changed || LargestMotion_m(matched_x_m_) >= tuning_.match_again_m) continue;
    }
    return Fit(frame);
  }
  return status;
}

int ShapeFitter::MatchingRounds() const {
  return (along_ == nullptr ? 1 : tuning_.rounds_along) * shape_.matching_rounds;
}

Eigen::MatrixXd ShapeFitter::SharedBias_m() const {
  Eigen::MatrixXd rows_m = Eigen::MatrixXd::Zero(targets_.Count(), along_->Shared().size());
  for (int r = 0; r < targets_.AlongNormals(); ++r) {
    const correspondence::FeatureMatch& match = (*matches_)[targets_.matched()[At(r)]];
    rows_m.row(r) = along_->ScaledBasis(match, poses_).transpose();
  }
  return rows_m;
}

/// Gauss-Newton step of bias and forces together, of which the bias is taken: the next fit gives
/// the forces. Alternating the two fits would creep where a contact resembles a bias. At the
/// optimum of the forces for the present bias b: G'S^-1 r = P f.
double ShapeFitter::FitBiasAlong() {
  if (targets_.Count() == 0) return 0.0;
  const Eigen::MatrixXd shared_m = SharedBias_m();
  const Eigen::VectorXd before = along_->Shared();
  const Eigen::MatrixXd weighted = targets_.targets().weight.asDiagonal() * shared_m;
  Eigen::MatrixXd information = weighted.transpose() * shared_m;
  information.diagonal().array() += 1.0;
  Eigen::VectorXd right_side =
      weighted.transpose() * (fitter_.fit().residual_m + shared_m * before);
  const Eigen::MatrixXd& forces_N2 = fitter_.fit().covariance_N2;
  if (forces_N2.size() > 0) {
    const Eigen::MatrixXd coupling = fitter_.Response().transpose() * weighted;
    const Eigen::MatrixXd gain = forces_N2 * coupling;
    information -= coupling.transpose() * gain;
    right_side -= gain.transpose() * (coupling * before);
  }
  const Eigen::VectorXd shared = linalg::Cholesky(information).Solve(right_side);
  along_->SetShared(shared);
  return (shared_m * (shared - before)).cwiseAbs().maxCoeff();
}

/// The bias is a further unknown with the prior sigma 1: the block of the forces in the inverse of
/// the joint information, by Woodbury's identity.
Eigen::MatrixXd ShapeFitter::Covariance_N2() const {
  const Eigen::MatrixXd& forces_N2 = fitter_.fit().covariance_N2;
  if (along_ == nullptr || forces_N2.size() == 0 || targets_.Count() == 0) return forces_N2;
  const Eigen::MatrixXd shared_m = SharedBias_m();
  const Eigen::MatrixXd weighted = targets_.targets().weight.asDiagonal() * shared_m;
  const Eigen::MatrixXd coupling = fitter_.Response().transpose() * weighted;
  const Eigen::MatrixXd gain = forces_N2 * coupling;
  Eigen::MatrixXd left = shared_m.transpose() * weighted - coupling.transpose() * gain;
  left.diagonal().array() += 1.0;
  return forces_N2 + gain * linalg::Cholesky(left).Solve(Eigen::MatrixXd(gain.transpose()));
}

Status ShapeFitter::MatchAndFitFromFar(const ShapeFrame& frame, const CameraBiases& bias) {
  if (limited_) return MatchAndFit(frame, bias);
  fitter_.LimitContinuationSteps(tuning_.most_continuation_steps);
  Status status = MatchAndFit(frame, bias);
  for (int more = 0; status.code() == StatusCode::kBudgetReached && more < tuning_.more_fits;
       ++more) {
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

/// To a coarse tolerance that shows whether the points must be matched again.
Status ShapeFitter::FitRoughly(const ShapeFrame& frame) {
  fitter_.SetTolerance(tuning_.rough_tolerances * shape_.fit_tolerance);
  SetForcePrior();
  const ForceFit& fit = fitter_.Fit(targets_.targets(), frame.cables, &state_, fit_budget_);
  fitter_.SetTolerance(shape_.fit_tolerance);
  CountSteps(fit);
  return fit.status;
}

/// With robust weights of the residual: one more fit where they have changed much.
Status ShapeFitter::Fit(const ShapeFrame& frame) {
  for (int k = 0;; ++k) {
    SetForcePrior();
    const ForceFit& fit = fitter_.Fit(targets_.targets(), frame.cables, &state_, fit_budget_);
    CountSteps(fit);
    if (!fit.status.ok()) return fit.status;
    if (!targets_.Reweight(fit.residual_m) || k == tuning_.reweightings) return Status::Ok();
  }
}

void ShapeFitter::CountSteps(const ForceFit& fit) {
  iterations_ += fit.iterations;
  linearisations_ += fit.iterations;
  chord_steps_ += fit.chord_steps;
}

bool ShapeFitter::RenewAgedFactor() {
  const bool in_frame = linearisations_ != linearisations_before_frame_;
  if (in_frame || chord_steps_ < tuning_.aged_chord_steps) return false;
  ++linearisations_;
  fitter_.RenewFactor(state_);
  return true;
}

Status ShapeFitter::FitAtNewLocations(const ShapeFrame& frame, const CameraBiases& bias) {
  places_moved_ = true;
  UseSites();
  return MatchAndFit(frame, bias);
}

Status ShapeFitter::Locate(const ShapeFrame& frame, const CameraBiases& bias) {
  const auto hidden = [](const ShapeSite& site) { return site.hidden; };
  if (std::all_of(sites().begin(), sites().end(), hidden)) {  // located by the search
    located_.clear();
    return Status::Ok();
  }
  if (!IsTimeToLocate() && located_.size() == sites().size()) return Status::Ok();
  for (int round = 0; round < tuning_.location_rounds; ++round) {
    if (!location_.Compute(sites(), targets_.targets(), state_, &located_).ok()) {
      located_.clear();
      return Status::Ok();  // forces and locations stay
    }
    if (MoveSites() < tuning_.locate_again_m || !places_moved_) return Status::Ok();
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
    const bool settled = sites()[s].frames >= tuning_.frames_to_settle;
    const double whole_m = located_[s].step_rest_m.norm();
    const double step_m =
        std::min(tuning_.longest_step_m, (settled ? tuning_.settled_share : 1.0) * whole_m);
    if (!(step_m > 0.0)) continue;
    longest_m = std::max(longest_m, step_m);
    places_moved_ = tracks_.Move(s, located_[s].step_rest_m * (step_m / whole_m)) || places_moved_;
  }
  return longest_m;
}

bool ShapeFitter::IsTimeToLocate() const {
  return std::any_of(sites().begin(), sites().end(), [this](const ShapeSite& site) {
    return site.frames < tuning_.frames_to_settle ||
           site.frames % tuning_.frames_between_locations == 0;
  });
}

double ShapeFitter::Misfit() const {
  return fitter_.fit().chi_squared / std::max(1, targets_.Count());
}

void ShapeFitter::KeepIn(Attempt* attempt) const {
  attempt->sites = tracks_.sites();
  attempt->state = state_;
  attempt->chi_squared = fitter_.fit().chi_squared;
}

void ShapeFitter::GoBack(const Attempt& attempt) {
  tracks_.GoBack(attempt.sites);
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

void ShapeFitter::Remove(std::size_t site) {
  Attempt rest;
  KeepIn(&rest);
  rest.sites.erase(rest.sites.begin() + static_cast<std::ptrdiff_t>(site));
  Eigen::VectorXd& forces_N = rest.state.lambda_f_N;
  const auto after = forces_N.size() - ToIndex(3 * site) - 3;
  forces_N.segment(ToIndex(3 * site), after) = forces_N.tail(after).eval();
  forces_N.conservativeResize(forces_N.size() - 3);
  GoBack(rest);
}

/// Their forces begin at zero, from where the steps stay near equilibria. The forces of the search
/// belong to a shape that the model does not have yet.
void ShapeFitter::ReplaceHidden(const std::vector<HiddenContact>& found) {
  tracks_.ReplaceHidden(found);
  places_moved_ = true;
  located_.clear();
  UseSites();
  for (std::size_t s = 0; s < sites().size(); ++s) {
    if (sites()[s].hidden) {
      state_.lambda_f_N.segment<3>(ToIndex(3 * s)).setZero();
    }
  }
}

}  // namespace palpate::force_estimation
