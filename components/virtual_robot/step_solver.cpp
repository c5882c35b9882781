// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/step_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::virtual_robot {

namespace {

fem::NodePairs AllPairs(const Forces& forces) {
  fem::NodePairs pairs = forces.elastic.CoupledPairs();
  const fem::NodePairs of_cables = forces.cables.CoupledPairs();
  pairs.insert(pairs.end(), of_cables.begin(), of_cables.end());
  const fem::NodePairs of_chambers = forces.chambers.CoupledPairs();
  pairs.insert(pairs.end(), of_chambers.begin(), of_chambers.end());
  return pairs;
}

/// In short steps an error in position is a large one in acceleration; rounding is the limit.
double Tolerance_m(const TimeScheme& scheme) {
  constexpr double kAcceleration_m_s2 = 1e-4;
  constexpr double kRounding_m = 1e-15;
  if (!scheme.dynamic) return StepSolver::kTolerance_m;
  const double usual_m =
      scheme.conserving() ? StepSolver::kConservingTolerance_m : StepSolver::kTolerance_m;
  return std::max(kRounding_m, std::min(usual_m, kAcceleration_m_s2 * scheme.h_s * scheme.h_s));
}

/// Whether a new factor is worth its price: with the present one it would take more than
/// kMostChords further corrections, each smaller by the same factor. Of the last one `share` was
/// applied: what is left of it says nothing about the factor.
bool IsTooSlow(double size_m, double last_m, double share, double tolerance_m) {
  constexpr double kMostChords = 7.0;
  if (size_m <= tolerance_m || !std::isfinite(last_m)) return false;
  const double rate = std::abs(size_m - (1.0 - share) * last_m) / (share * last_m);
  return rate >= 1.0 || std::log(tolerance_m / size_m) < kMostChords * std::log(rate);
}

bool IsNear(double a, double b) {
  constexpr double kRelative = 0.01;
  return std::abs(a - b) <= kRelative * std::abs(a);
}

}  // namespace

StepSolver::StepSolver(const Forces& forces, const fem::FixedDirections& fixed, int threads)
    : forces_(forces),
      matrix_(fixed, AllPairs(forces)),
      team_(std::make_shared<ThreadTeam>(threads)),
      solver_{fem::MakeMultifrontalSolver(matrix_.Pattern(), *team_)} {
  for (int node = 0; node < static_cast<int>(fixed.cols()); ++node) {
    if (fixed.col(node).all()) clamped_.push_back(node);
  }
  forces_.elastic.BindTo(matrix_, team_);
  forces_.mass.BindTo(matrix_);
  forces_.viscosity.BindTo(matrix_);
  forces_.cables.BindTo(matrix_);
  forces_.chambers.BindTo(matrix_);
  solver_->KeepSinglePrecision();  // each correction is followed by the balance that it leads to
  const int pieces = forces_.cables.PieceCount();
  nodal_ = Eigen::VectorXd::Zero(3 * fixed.cols());
  correction_ = Eigen::MatrixXd::Zero(matrix_.Size(), 1);
  gradients_ = Eigen::MatrixXd::Zero(nodal_.size(), pieces);
  columns_ = Eigen::MatrixXd::Zero(matrix_.Size(), pieces);
  reduced_ = columns_;
}

void StepSolver::AddEnergyCorrection(const MotionState& from, const MotionState& to) {
  const Eigen::VectorXd moved_m = to.x_m - from.x_m;
  Eigen::VectorXd along = Eigen::VectorXd::Zero(moved_m.size());
  forces_.mass.AddProduct(moved_m, 1.0, along);
  const double squared = along.dot(moved_m);
  double min_J = 0.0;
  const double change_J = forces_.elastic.Energy(to.x_m, &min_J) - energy_before_J_;
  constexpr double kRounding = 1e-14;
  const bool significant = std::abs(change_J) > kRounding * std::abs(energy_before_J_);
  if (!(squared > 0.0) || !(min_J > 0.0) || !significant) return;
  nodal_ += (change_J - nodal_.dot(moved_m)) / squared * along;
}

/// A clamp that turns does so slowly: its nodes count as at rest.
void StepSolver::SetRates(const StepTask& task, const MotionState& from, MotionState* to) const {
  task.scheme.SetRates(from, to);
  for (const int node : clamped_) {
    to->v_m_s.segment<3>(3 * node).setZero();
    to->a_m_s2.segment<3>(3 * node).setZero();
  }
}

void StepSolver::AddInertia(const StepTask& task, const MotionState& from, MotionState* to) {
  const TimeScheme& scheme = task.scheme;
  if (!scheme.dynamic) return;
  SetRates(task, from, to);
  acceleration_m_s2_ =
      (1.0 - scheme.alpha_m) * to->a_m_s2 + scheme.alpha_m * from.a_m_s2 +
      forces_.mass_damping_1_s * ((1.0 - scheme.alpha_f) * to->v_m_s + scheme.alpha_f * from.v_m_s);
  forces_.mass.AddProduct(acceleration_m_s2_, -1.0, nodal_);
}

Status StepSolver::Balance(const StepTask& task, const MotionState& from, MotionState* to,
                           bool with_tangent) {
  const double alpha_f = task.scheme.alpha_f;
  intermediate_m_ = (1.0 - alpha_f) * to->x_m + alpha_f * from.x_m;
  nodal_.setZero();
  const double min_J =
      with_tangent ? forces_.elastic.AddForcesAndSetTangent(intermediate_m_, nodal_, matrix_)
                   : forces_.elastic.AddForces(intermediate_m_, nodal_);
  if (!nodal_.allFinite()) return {StatusCode::kNotConverged, "the forces are not finite"};
  if (!(min_J > 0.0)) return {StatusCode::kInverted, "an element turned inside out"};
  if (task.scheme.conserving() && !forces_.viscosity.active()) AddEnergyCorrection(from, *to);
  nodal_ = task.load_N - forces_.viscosity.scale() * nodal_;
  if (forces_.viscosity.active()) {
    forces_.viscosity.history().AddProduct(intermediate_m_, -1.0, nodal_);
  }
  AddInertia(task, from, to);
  for (Contact& contact : forces_.contacts) {
    contact.Evaluate(forces_.surface, to->x_m);
    contact.AddForces(forces_.surface, nodal_);
  }
  forces_.cables.Evaluate(to->x_m);
  forces_.cables.AddForces(1.0, nodal_);
  forces_.chambers.AddForces(to->x_m, nodal_);
  return with_tangent ? Factorise(task, to->x_m) : Status::Ok();
}

Status StepSolver::Factorise(const StepTask& task, const Eigen::VectorXd& x_m) {
  const TimeScheme& scheme = task.scheme;
  const double scale = scheme.PositionRate() * forces_.viscosity.scale();
  for (double& value : matrix_.Values()) value *= scale;
  if (forces_.viscosity.active()) {
    forces_.viscosity.history().AddTo(scheme.PositionRate(), matrix_);
  }
  if (scheme.dynamic) {
    forces_.mass.AddTo(scheme.AccelerationRate() + forces_.mass_damping_1_s * scheme.VelocityRate(),
                       matrix_);
  }
  for (Contact& contact : forces_.contacts) {
    contact.AddStiffness(forces_.surface, matrix_);
    contact.Remember();
  }
  forces_.cables.AddCurvature(matrix_);
  forces_.chambers.AddCurvature(x_m, matrix_);
  matrix_.FixSingleDirections();
  has_factor_ = false;
  if (Status status = FactoriseShifted(); !status.ok()) return status;
  has_factor_ = true;
  factor_scheme_ = scheme;
  factor_scale_ = forces_.viscosity.scale();
  if (forces_.cables.PieceCount() == 0) return Status::Ok();
  forces_.cables.Gradients(&gradients_);
  for (Eigen::Index j = 0; j < gradients_.cols(); ++j) {
    matrix_.Reduce(gradients_.col(j), reduced_.col(j));
  }
  columns_ = reduced_;
  solver_->SolveSingle(columns_);
  compliance_m_N_ = reduced_.transpose() * columns_;
  return Status::Ok();
}

/// Where the tangent has no Cholesky factor, a multiple of the identity is added.
Status StepSolver::FactoriseShifted() {
  constexpr double kSmallestShift = 1e-4;
  constexpr double kLargestShift = 1.0;
  ++cost_.factorisations;
  shifted_ = false;
  Status factorised = solver_->Factorize(matrix_.Values());
  for (double shift = kSmallestShift;
       factorised.code() == StatusCode::kNotPositiveDefinite && shift <= kLargestShift;
       shift *= 10.0) {
    matrix_.AddRelativeShift(shift);
    shifted_ = true;
    factorised = solver_->Factorize(matrix_.Values());
  }
  return factorised;
}

bool StepSolver::Correct() {
  matrix_.Reduce(nodal_, correction_.col(0));
  const Eigen::VectorXd left_N = correction_.col(0);
  solver_->SolveSingle(correction_);
  work_in_hand_ = left_N.dot(correction_.col(0));
  if (forces_.cables.PieceCount() == 0) return true;
  forces_.cables.Gradients(&gradients_);
  for (Eigen::Index j = 0; j < gradients_.cols(); ++j) {
    matrix_.Reduce(gradients_.col(j), reduced_.col(j));
  }
  const Eigen::VectorXd before_N = forces_.cables.tension_N();
  const Eigen::VectorXd slack_m = forces_.cables.Lengths_m() +
                                  reduced_.transpose() * correction_.col(0) +
                                  compliance_m_N_ * before_N;
  if (!forces_.cables.SolveTensions(slack_m, compliance_m_N_)) return false;
  const Eigen::VectorXd change_N = forces_.cables.tension_N() - before_N;
  correction_.col(0) -= columns_ * change_N;
  work_in_hand_ = (left_N - reduced_ * change_N).dot(correction_.col(0));
  return true;
}

void StepSolver::Move(double share, MotionState* to) const {
  matrix_.AddExpanded(correction_.col(0), share, to->x_m);
}

/// Rates, contacts and cables at the very end of the step.
void StepSolver::Finish(const StepTask& task, const MotionState& from, MotionState* to) {
  SetRates(task, from, to);
  for (Contact& contact : forces_.contacts) contact.Evaluate(forces_.surface, to->x_m);
  forces_.cables.Evaluate(to->x_m);
}

bool StepSolver::ContactsChanged() const {
  return std::any_of(forces_.contacts.begin(), forces_.contacts.end(), [](const Contact& contact) {
    return contact.ChangeSinceRemembered() > kLargestChange;
  });
}

bool StepSolver::Fits(const TimeScheme& scheme) const {
  return has_factor_ && scheme.dynamic == factor_scheme_.dynamic &&
         IsNear(factor_scale_, forces_.viscosity.scale()) &&
         (!scheme.dynamic ||
          (scheme.alpha_f == factor_scheme_.alpha_f && IsNear(scheme.h_s, factor_scheme_.h_s)));
}

/// The balance where the last correction led to, which is cut short where it inverts an element, or
/// where it ends too deep in a tool. Elastic forces may take more work than the correction had in
/// hand: near incompressibility a bending body passes through stretched states, and cutting them
/// short costs ten times the corrections.
Status StepSolver::BalanceAlong(const StepTask& task, const MotionState& from, MotionState* to) {
  constexpr int kMostCuts = 10;
  share_ = GoAsFarAsContactsLet(to);
  for (int cut = 0;; ++cut) {
    const Status status = Balance(task, from, to, false);
    if (status.code() != StatusCode::kInverted || cut == kMostCuts) return status;
    share_ *= 0.5;
    Move(-share_, to);
  }
}

/// The contacts may take half more than the work that the correction had in hand. Where they would
/// take more, it is cut to within a third of what they bear: they are cheap to ask, whereas a body
/// that creeps up to a tool costs a correction for each step. Returns the share that is left.
double StepSolver::GoAsFarAsContactsLet(MotionState* to) {
  constexpr int kMostLooks = 16;
  constexpr double kNearEnough = 0.75;
  const double most = 1.5 * work_in_hand_;
  const double work_before = ContactWork();
  double share = 1.0;
  double borne = 0.0;
  double too_far = 1.0;
  for (int look = 0; look < kMostLooks; ++look) {
    for (Contact& contact : forces_.contacts) contact.Evaluate(forces_.surface, to->x_m);
    const double taken = work_before - ContactWork();
    if (taken <= most && look == 0) return share;
    (taken <= most ? borne : too_far) = share;
    if (borne >= kNearEnough * too_far) break;
    const double next = borne > 0.0 ? 0.5 * (borne + too_far)
                                    : too_far * std::clamp(work_in_hand_ / taken, 0.1, kNearEnough);
    Move(next - share, to);
    share = next;
  }
  const double last = borne > 0.0 ? borne : too_far;
  Move(last - share, to);
  return last;
}

/// Of the contacts' present forces along the last correction.
double StepSolver::ContactWork() const {
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(nodal_.size());
  Eigen::VectorXd reduced_N(matrix_.Size());
  for (const Contact& contact : forces_.contacts) contact.AddForces(forces_.surface, force_N);
  matrix_.Reduce(force_N, reduced_N);
  return reduced_N.dot(correction_.col(0));
}

void StepSolver::FollowTools(const StepTask& task, const MotionState& from, double share,
                             Eigen::VectorXd* start_m) {
  constexpr double kSmallestTurn_m = 1e-6;
  constexpr double kLargestWay_m = 0.02;
  if (task.scheme.dynamic || !Fits(task.scheme) || ContactsChanged()) return;
  nodal_.setZero();
  double largest_m = 0.0;
  for (const Contact& contact : forces_.contacts) {
    largest_m =
        std::max(largest_m, contact.AddForcesOfTurn(forces_.surface, from.x_m, share, nodal_));
  }
  if (largest_m < kSmallestTurn_m) return;
  const Eigen::VectorXd tension_N = forces_.cables.tension_N();
  forces_.cables.Evaluate(*start_m);
  if (Correct() && correction_.cwiseAbs().maxCoeff() <= kLargestWay_m) {
    matrix_.AddExpanded(correction_.col(0), 1.0, *start_m);
  } else {
    forces_.cables.SetTensions(tension_N);
  }
}

Status StepSolver::Solve(const StepTask& task, const MotionState& from, MotionState* to) {
  const double tolerance_m = Tolerance_m(task.scheme);
  to->x_m = task.start_m;
  if (task.scheme.conserving()) {
    double min_J = 0.0;
    energy_before_J_ = forces_.elastic.Energy(from.x_m, &min_J);
  }
  correction_.setZero();
  work_in_hand_ = 0.0;
  bool refresh = !Fits(task.scheme);
  double last_m = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostCorrections; ++k) {
    ++cost_.corrections;
    const Status status = refresh ? Balance(task, from, to, true) : BalanceAlong(task, from, to);
    if (!status.ok()) return status;
    if (!refresh && ContactsChanged()) {
      refresh = true;
      continue;
    }
    if (!Correct()) return {StatusCode::kNotConverged, "the tensions of the cables are not found"};
    const double size_m = correction_.cwiseAbs().maxCoeff();
    if (!(size_m <= kLargestCorrection_m)) {
      return {StatusCode::kNotConverged, "the corrections of a time step grow without end"};
    }
    if (!refresh && IsTooSlow(size_m, last_m, share_, tolerance_m)) {
      refresh = true;
      last_m = std::numeric_limits<double>::infinity();
      correction_.setZero();
      continue;
    }
    Move(1.0, to);
    const double left_m = std::isfinite(last_m) ? size_m * size_m / last_m : size_m;
    if (size_m <= tolerance_m || (left_m < 0.5 * size_m && left_m <= 0.5 * tolerance_m)) {
      if (shifted_ && !task.scheme.dynamic) {
        return {StatusCode::kNotConverged, "the balance is unstable"};
      }
      Finish(task, from, to);
      return Status::Ok();
    }
    refresh = false;
    last_m = size_m;
  }
  return {StatusCode::kNotConverged, "the corrections of a time step do not end"};
}

}  // namespace palpate::virtual_robot
