// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/marker_fitter.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::force_estimation {

namespace {

constexpr double kBalanceTolerance = 1e-9;  ///< residual over internal forces
constexpr int kMaxSetChanges = 12;          ///< of taut and slack cables in one linearisation
/// Residual over internal forces up to which a linear step may be taken as it is: from there on
/// Newton's steps converge by themselves.
constexpr double kLinearStepTolerance = 1e-3;

/// A step that needs more load steps than these is halved instead.
constexpr fem::StaticSettings kFollowSettings{.max_newton_iterations = 20, .max_load_steps = 6};

std::vector<fem::NodeWeights> MarkerRows(const robot::RobotModel& model) {
  std::vector<fem::NodeWeights> rows;
  for (const robot::BodyMarker& marker : model.body().markers) rows.push_back(marker.point.weights);
  return rows;
}

std::vector<robot::ForceDirection> Directions(const std::vector<FitSite>& sites) {
  std::vector<robot::ForceDirection> directions;
  for (const FitSite& site : sites) {
    for (int i = 0; i < 3; ++i) {
      directions.push_back({site.patch.weights, Eigen::Vector3d::Unit(i)});
    }
  }
  return directions;
}

/// Inverse on the directions that have information; infinite variances are left out by the basis.
fem::QpMatrix PseudoInverse(const fem::QpMatrix& information) {
  const Eigen::SelfAdjointEigenSolver<fem::QpMatrix> eigen(information);
  fem::QpMatrix inverse = fem::QpMatrix::Zero(information.rows(), information.cols());
  for (Eigen::Index k = 0; k < information.rows(); ++k) {
    const double value = eigen.eigenvalues()[k];
    if (value <= 1e-14 * eigen.eigenvalues().maxCoeff()) continue;
    inverse += eigen.eigenvectors().col(k) * eigen.eigenvectors().col(k).transpose() / value;
  }
  return inverse;
}

}  // namespace

MarkerFitter::MarkerFitter(robot::RobotModel& model, const Config& config)
    : model_(model),
      config_(config),
      compliance_(model.linearisation(), MarkerRows(model)),
      equilibrium_(model.linearisation(), kFollowSettings),
      elimination_(static_cast<int>(3 * model.body().markers.size()), model.CableCount()),
      weight_N_(Eigen::VectorXd::Zero(model.elastic_body().rest_m().size())),
      external_force_N_(weight_N_),
      new_lambda_a_(model.CableCount()),
      trial_x_(weight_N_),
      nodal_(weight_N_),
      effector_motion_(static_cast<Eigen::Index>(3 * model.body().markers.size())),
      cable_motion_(model.CableCount()),
      modulus_column_(model.linearisation().Size(), 1) {
  model_.AddWeight(weight_N_);
  fit_.residual_m = Eigen::VectorXd::Zero(effector_motion_.size());
}

void MarkerFitter::SetSites(const std::vector<FitSite>& sites) {
  PALPATE_CHECK(3 * sites.size() <= static_cast<size_t>(fem::kMaxQpVariables), sites.size());
  sites_ = sites;
  compliance_.SetForces(Directions(sites));
  const auto forces = static_cast<Eigen::Index>(3 * sites.size());
  new_lambda_f_ = Eigen::VectorXd::Zero(forces);
  fit_.covariance_N2 = Eigen::MatrixXd::Zero(forces, forces);
  fit_.modulus_sensitivity_N = Eigen::VectorXd::Zero(forces);
  fit_.observability.assign(sites.size(), Observability::kFull);
  fit_.unknowns.assign(sites.size(), 3);
  directions_.assign(sites.size(), Eigen::Matrix3d::Identity());
  AskForEverything();
}

const MarkerFit& MarkerFitter::Fit(const MarkerTargets& targets,
                                   const std::vector<robot::CableCommand>& cables,
                                   ModelState* state) {
  PALPATE_CHECK(SiteCount() > 0);
  weight_N_.setZero();
  model_.AddWeight(weight_N_);
  AskForEverything();
  elimination_.Start(cables, state->lambda_a_N);
  for (fit_.iterations = 0; fit_.iterations <= config_.max_iterations; ++fit_.iterations) {
    fit_.status = Linearise(*state);
    if (fit_.status.ok()) fit_.status = SolveQp(targets, cables, *state);
    if (!fit_.status.ok()) return fit_;
    if (fit_.iterations == 0) {
      KeepObservable(targets);
      fit_.status = SolveQp(targets, cables, *state);
      if (!fit_.status.ok()) return fit_;
    }
    const double change = LargestChange(*state);
    const bool balanced = Balanced(*state);
    if (!Step(targets, cables, state)) {
      fit_.status = Status(StatusCode::kNotConverged, {});
      return fit_;
    }
    if (balanced && change <= config_.force_tolerance_N) {
      Conclude(targets, *state);
      return fit_;
    }
  }
  fit_.status = Status(StatusCode::kNotConverged, {});
  return fit_;
}

Status MarkerFitter::Linearise(const ModelState& state) {
  UpdateExternalForce(state.lambda_f_N);
  Status status = model_.linearisation().Update(state.x_m, state.lambda_a_N, external_force_N_,
                                                /*allow_shift=*/true);
  if (!status.ok()) return status;
  compliance_.Compute(state.x_m, model_.cable_rest_length_m(), state.lambda_a_N, state.lambda_f_N);
  return status;
}

void MarkerFitter::UpdateExternalForce(const Eigen::VectorXd& lambda_f_N) {
  external_force_N_ = weight_N_;
  for (size_t f = 0; f < compliance_.forces().size(); ++f) {
    compliance_.forces()[f].AddForce(lambda_f_N[static_cast<Eigen::Index>(f)], external_force_N_);
  }
}

/// G' S^-1 G
fem::QpMatrix MarkerFitter::Information(const MarkerTargets& targets) const {
  const Eigen::MatrixXd& G = elimination_.G();
  fem::QpMatrix information(G.cols(), G.cols());
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      information(i, j) = information(j, i) =
          (G.col(i).array() * G.col(j).array() * targets.weight.array()).sum();
    }
  }
  return information;
}

/// Eqs. (11), (12) in the observable directions, the taut cables found along with the forces.
Status MarkerFitter::SolveQp(const MarkerTargets& targets,
                             const std::vector<robot::CableCommand>& cables,
                             const ModelState& state) {
  const Eigen::Index q = basis_.cols();
  fem::BoundedQp qp;
  qp.lower = fem::QpVector::Constant(q, -std::numeric_limits<double>::infinity());
  qp.upper = -qp.lower;
  qp_start_ = basis_.transpose() * state.lambda_f_N;
  for (int round = 0; round < kMaxSetChanges; ++round) {
    if (Status status = elimination_.Eliminate(compliance_, cables); !status.ok()) return status;
    const Eigen::MatrixXd& G = elimination_.G();
    fem::QpVector c(G.cols());
    for (Eigen::Index j = 0; j < G.cols(); ++j) {
      c[j] = (G.col(j).array() * targets.weight.array() *
              (elimination_.e0_m() - targets.position_m).array())
                 .sum();
    }
    qp.H = basis_.transpose() * Information(targets) * basis_;
    qp.c = basis_.transpose() * c;
    const fem::BoundedQpResult solution = fem::SolveBoundedQp(qp, qp_start_);
    if (!solution.status.ok()) return solution.status;
    new_lambda_f_ = basis_ * solution.x;
    if (elimination_.Settle(compliance_, cables, new_lambda_f_)) break;
  }
  elimination_.CableForces(new_lambda_f_, &new_lambda_a_);
  return Status::Ok();
}

/// Every direction, or the given one, of every site.
void MarkerFitter::AskForEverything() {
  for (size_t s = 0; s < sites_.size(); ++s) {
    const bool free = sites_[s].direction.isZero();
    fit_.observability[s] = Observability::kFull;
    fit_.unknowns[s] = free ? 3 : 1;
    directions_[s].setIdentity();
    if (!free) directions_[s].col(0) = sites_[s].direction;
  }
  BuildBasis();
}

void MarkerFitter::BuildBasis() {
  Eigen::Index columns = 0;
  for (const int unknowns : fit_.unknowns) columns += unknowns;
  basis_ = fem::QpMatrix::Zero(static_cast<Eigen::Index>(3 * sites_.size()), columns);
  Eigen::Index column = 0;
  for (size_t s = 0; s < sites_.size(); ++s) {
    const Eigen::Index unknowns = fit_.unknowns[s];
    basis_.block(static_cast<Eigen::Index>(3 * s), column, 3, unknowns) =
        directions_[s].leftCols(unknowns);
    column += unknowns;
  }
}

/// Leaves out the directions in which a force is uncertain by more than the limit, taking the
/// other contacts' uncertainty into account.
void MarkerFitter::KeepObservable(const MarkerTargets& targets) {
  const double limit = config_.unobservable_sigma_N * config_.unobservable_sigma_N;
  const fem::QpMatrix information = basis_.transpose() * Information(targets) * basis_;
  const Eigen::SelfAdjointEigenSolver<fem::QpMatrix> eigen(information);
  // What the markers do not see at all gets a variance that is large, yet a number.
  const fem::QpVector variances = eigen.eigenvalues().cwiseMax(1e-9 / limit).cwiseInverse();
  const fem::QpMatrix covariance = basis_ * eigen.eigenvectors() * variances.asDiagonal() *
                                   eigen.eigenvectors().transpose() * basis_.transpose();
  for (size_t s = 0; s < sites_.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(3 * s);
    const Eigen::Matrix3d own_covariance = covariance.block<3, 3>(row, row);
    if (!sites_[s].direction.isZero()) {
      if (own_covariance.trace() <= limit) continue;
      fit_.observability[s] = Observability::kNone;
      fit_.unknowns[s] = 0;
      continue;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> own(own_covariance);
    if (own.eigenvalues()[2] <= limit) continue;
    const Eigen::Vector3d normal = sites_[s].patch.normal;
    const bool normal_known = normal.dot(own_covariance * normal) <= limit;
    fit_.observability[s] = normal_known ? Observability::kNormal : Observability::kNone;
    if (normal_known) {
      KeepNormal(s, own_covariance);
      continue;
    }
    directions_[s] = own.eigenvectors();
    fit_.unknowns[s] = 0;
    while (fit_.unknowns[s] < 3 && own.eigenvalues()[fit_.unknowns[s]] <= limit) {
      ++fit_.unknowns[s];
    }
  }
  BuildBasis();
}

/// The normal itself and, where it is certain enough, the better known tangent: the force along the
/// other counts as zero, which leaves a force along the normal what it is.
void MarkerFitter::KeepNormal(size_t site, const Eigen::Matrix3d& covariance_N2) {
  const Eigen::Vector3d normal = sites_[site].patch.normal;
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(tangents.transpose() * covariance_N2 *
                                                             tangents);
  directions_[site] << normal, tangents * eigen.eigenvectors();
  const double limit = config_.unobservable_sigma_N * config_.unobservable_sigma_N;
  fit_.unknowns[site] = eigen.eigenvalues()[0] <= limit ? 2 : 1;
}

double MarkerFitter::ForceScale(const ModelState& state) const {
  return std::max({model_.linearisation().internal_force_norm_N(), weight_N_.norm(),
                   state.lambda_f_N.norm(), 1e-9});
}

bool MarkerFitter::Balanced(const ModelState& state) const {
  const fem::Linearisation& linearisation = model_.linearisation();
  return !linearisation.shifted() &&
         linearisation.residual_N().norm() <= kBalanceTolerance * ForceScale(state);
}

/// Largest change of a force that the QP asks for, relative where forces are above 1 N.
double MarkerFitter::LargestChange(const ModelState& state) const {
  double change = (new_lambda_f_ - state.lambda_f_N).cwiseAbs().maxCoeff();
  if (state.lambda_a_N.size() > 0) {
    change = std::max(change, (new_lambda_a_ - state.lambda_a_N).cwiseAbs().maxCoeff());
  }
  return change / std::max(1.0, new_lambda_f_.cwiseAbs().maxCoeff());
}

/// The linear step where it is short enough; else the forces are changed as far as the residual of
/// the markers falls, the model following in equilibrium.
bool MarkerFitter::Step(const MarkerTargets& targets,
                        const std::vector<robot::CableCommand>& cables, ModelState* state) {
  if (StepByLinearResponse(state)) return true;
  constexpr int kHalvings = 8;
  double fraction = 1.0;
  for (int k = 0; k < kHalvings; ++k, fraction *= 0.5) {
    if (StepToEquilibrium(targets, cables, fraction, state)) return true;
  }
  return false;
}

bool MarkerFitter::StepByLinearResponse(ModelState* state) {
  if (model_.linearisation().shifted()) return false;
  trial_x_ = state->x_m;
  compliance_.UpdateConfiguration(new_lambda_a_, new_lambda_f_, 1.0, &trial_x_);
  UpdateExternalForce(new_lambda_f_);
  const Status status =
      model_.linearisation().UpdateResidual(trial_x_, new_lambda_a_, external_force_N_);
  if (!status.ok() ||
      model_.linearisation().residual_N().norm() > kLinearStepTolerance * ForceScale(*state)) {
    return false;
  }
  state->x_m = trial_x_;
  state->lambda_f_N = new_lambda_f_;
  state->lambda_a_N = new_lambda_a_;
  state->balanced = false;
  return true;
}

bool MarkerFitter::StepToEquilibrium(const MarkerTargets& targets,
                                     const std::vector<robot::CableCommand>& cables,
                                     double fraction, ModelState* state) {
  ModelState trial = *state;
  trial.lambda_f_N += fraction * (new_lambda_f_ - state->lambda_f_N);
  fem::LoadState loads = model_.Loads(cables, {});
  fem::StaticState body{state->x_m, state->lambda_a_N, loads};
  UpdateExternalForce(state->lambda_f_N);
  body.loads.external_force_N = external_force_N_;
  UpdateExternalForce(trial.lambda_f_N);
  loads.external_force_N = external_force_N_;
  if (!equilibrium_.Solve(loads, &body).status.ok()) return false;
  trial.x_m = body.x_m;
  trial.lambda_a_N = body.multipliers_N;
  // The residual before counts only where the state before was an equilibrium.
  const double before = ChiSquared(targets, *state, &fit_.residual_m);
  const double after = ChiSquared(targets, trial, &fit_.residual_m);
  if (state->balanced && after > before * (1.0 + 1e-9)) return false;
  *state = std::move(trial);
  state->balanced = true;
  return true;
}

double MarkerFitter::ChiSquared(const MarkerTargets& targets, const ModelState& state,
                                Eigen::VectorXd* residual_m) const {
  const auto& markers = model_.body().markers;
  double sum = 0.0;
  for (size_t m = 0; m < markers.size(); ++m) {
    const auto row = static_cast<Eigen::Index>(3 * m);
    const Eigen::Vector3d position = markers[m].point.weights.Position(state.x_m);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const bool seen = targets.weight[row + i] > 0.0;
      const double residual = seen ? targets.position_m[row + i] - position[i] : 0.0;
      (*residual_m)[row + i] = residual;
      sum += targets.weight[row + i] * residual * residual;
    }
  }
  return sum;
}

Status MarkerFitter::CheckTensions(const ModelState& state) const {
  for (int c = 0; c < model_.CableCount(); ++c) {
    const double tension_N = state.lambda_a_N[c];
    if (tension_N < 0.0) return {StatusCode::kNotConverged, {}};
    if (tension_N > model_.body().cables[static_cast<size_t>(c)].max_tension_N) {
      return {StatusCode::kTensionLimit, {}};
    }
  }
  return Status::Ok();
}

void MarkerFitter::Conclude(const MarkerTargets& targets, const ModelState& state) {
  fit_.chi_squared = ChiSquared(targets, state, &fit_.residual_m);
  fit_.status = CheckTensions(state);
  if (!fit_.status.ok()) return;
  const fem::QpMatrix reduced = basis_.transpose() * Information(targets) * basis_;
  fit_.covariance_N2 = basis_ * PseudoInverse(reduced) * basis_.transpose();
  ModulusSensitivity(targets, state);
  fit_.status = Status::Ok();
}

/// With stiffer material the same shape needs larger forces: internal forces grow with ln E, and
/// the fit answers by dlambda_f = -(G' S^-1 G)^-1 G' S^-1 de/dlnE.
void MarkerFitter::ModulusSensitivity(const MarkerTargets& targets, const ModelState& state) {
  nodal_.setZero();
  model_.elastic_body().AddForces(state.x_m, nodal_);
  nodal_ *= -1.0;
  const fem::Linearisation& linearisation = model_.linearisation();
  linearisation.matrix().Reduce(nodal_, modulus_column_.col(0));
  model_.linearisation().Solve(modulus_column_);
  nodal_.setZero();
  linearisation.matrix().AddExpanded(modulus_column_.col(0), 1.0, nodal_);
  const auto& markers = model_.body().markers;
  for (size_t m = 0; m < markers.size(); ++m) {
    effector_motion_.segment<3>(static_cast<Eigen::Index>(3 * m)) =
        markers[m].point.weights.Position(nodal_);
  }
  for (int c = 0; c < model_.CableCount(); ++c) {
    trial_x_.setZero();
    model_.cable(c).AddGradient(state.x_m, -1.0, trial_x_);
    cable_motion_[c] = trial_x_.dot(nodal_);
  }
  elimination_.HoldTautCables(compliance_, cable_motion_, &effector_motion_);
  const Eigen::MatrixXd& G = elimination_.G();
  fem::QpVector pull(G.cols());
  for (Eigen::Index j = 0; j < G.cols(); ++j) {
    pull[j] = (G.col(j).array() * targets.weight.array() * effector_motion_.array()).sum();
  }
  fit_.modulus_sensitivity_N.noalias() = -fit_.covariance_N2 * pull;
}

}  // namespace palpate::force_estimation
