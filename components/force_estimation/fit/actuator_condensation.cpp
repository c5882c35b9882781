// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/actuator_condensation.hpp"

#include <algorithm>

#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::force_estimation {

namespace {

using Kind = robot::ActuatorCommand::Kind;

struct CondensationTuning {
  /// A slack cable becomes taut where its displacement falls short by more than this. Anything
  /// above rounding and far below the noise of a cable input gives the same cables.
  double displacement_tolerance_m = 1e-12;
  /// Changes of one cable between taut and slack. More follow a difficult transition further, fewer
  /// end a cycle sooner.
  int most_changes_of_a_cable = 3;
};
constexpr CondensationTuning kCondensationTuning;

}  // namespace

ActuatorCondensation::ActuatorCondensation(int effector_rows,
                                           const std::vector<robot::ActuatorTraits>& traits)
    : fixed_(Eigen::VectorXd::Zero(std::ssize(traits))),
      changes_(traits.size(), 0),
      e0_(effector_rows),
      lambda_a_(fixed_),
      delta_a_(fixed_) {
  taut_.reserve(traits.size());
  for (const robot::ActuatorTraits& one : traits) least_force_N_.push_back(one.least_force_N);
}

void ActuatorCondensation::Start(const std::vector<robot::ActuatorCommand>& commands,
                                 const Eigen::VectorXd& lambda_a_N) {
  taut_.clear();
  std::fill(changes_.begin(), changes_.end(), 0);
  for (size_t c = 0; c < commands.size(); ++c) {
    const auto row = ToIndex(c);
    fixed_[row] = commands[c].kind == Kind::kTension ? commands[c].value : 0.0;
    if (commands[c].kind != Kind::kDisplacement) continue;
    if (lambda_a_N[row] > least_force_N_[c]) {
      taut_.push_back(static_cast<int>(c));
    } else {
      fixed_[row] = least_force_N_[c];
    }
  }
}

Status ActuatorCondensation::Condense(const robot::Compliance& compliance,
                                      const std::vector<robot::ActuatorCommand>& commands) {
  const auto t = ToIndex(taut_.size());
  const Eigen::Index f = compliance.W_ef().cols();
  G_ = compliance.W_ef();
  e0_ = compliance.delta_e_free_m();
  e0_.noalias() += compliance.W_ea() * fixed_;
  inverse_TT_.resize(t, t);
  T_taut_.resize(t, f);
  t0_taut_.resize(t);
  if (t == 0) return Status::Ok();

  fem::QpMatrix W_TT(t, t);
  for (Eigen::Index i = 0; i < t; ++i) {
    const int cable = taut_[At(i)];
    for (Eigen::Index j = 0; j < t; ++j) {
      W_TT(i, j) = compliance.W_aa()(cable, taut_[At(j)]);
    }
    T_taut_.row(i) = -compliance.W_af().row(cable);
    t0_taut_[i] = commands[At(cable)].value - compliance.delta_a_free_m()[cable] -
                  compliance.W_aa().row(cable).dot(fixed_);
  }
  if (!linalg::InverseSpd(W_TT, &inverse_TT_)) return {StatusCode::kUnobservable, {}};
  T_taut_ = (inverse_TT_ * T_taut_).eval();
  t0_taut_ = (inverse_TT_ * t0_taut_).eval();
  for (Eigen::Index i = 0; i < t; ++i) {
    const auto W_e = compliance.W_ea().col(taut_[At(i)]);
    for (Eigen::Index j = 0; j < f; ++j) G_.col(j) += T_taut_(i, j) * W_e;
    e0_ += t0_taut_[i] * W_e;
  }
  return Status::Ok();
}

void ActuatorCondensation::CableForces(const Eigen::VectorXd& lambda_f_N,
                                       Eigen::VectorXd* lambda_a_N) const {
  *lambda_a_N = fixed_;
  for (size_t i = 0; i < taut_.size(); ++i) {
    const auto row = ToIndex(i);
    (*lambda_a_N)[taut_[i]] = t0_taut_[row] + T_taut_.row(row).dot(lambda_f_N);
  }
}

bool ActuatorCondensation::Settle(const robot::Compliance& compliance,
                                  const std::vector<robot::ActuatorCommand>& commands,
                                  const Eigen::VectorXd& lambda_f_N) {
  CableForces(lambda_f_N, &lambda_a_);
  compliance.CableDisplacements(lambda_a_, lambda_f_N, &delta_a_);
  bool settled = true;
  for (size_t c = 0; c < commands.size(); ++c) {
    if (commands[c].kind != Kind::kDisplacement ||
        changes_[c] >= kCondensationTuning.most_changes_of_a_cable)
      continue;
    const auto row = ToIndex(c);
    const auto place = std::find(taut_.begin(), taut_.end(), static_cast<int>(c));
    const bool taut = place != taut_.end();
    const bool pushes = taut && lambda_a_[row] < least_force_N_[c];
    const bool too_long =
        !taut && delta_a_[row] < commands[c].value - kCondensationTuning.displacement_tolerance_m;
    if (pushes) taut_.erase(place);
    if (too_long) taut_.push_back(static_cast<int>(c));
    if (pushes || too_long) fixed_[row] = pushes ? least_force_N_[c] : 0.0;
    if (pushes || too_long) {
      ++changes_[c];
      settled = false;
    }
  }
  return settled;
}

void ActuatorCondensation::HoldTautCables(const robot::Compliance& compliance,
                                          const Eigen::VectorXd& cable_motion_m,
                                          Eigen::VectorXd* effector_motion_m) const {
  for (size_t i = 0; i < taut_.size(); ++i) {
    double tension = 0.0;
    for (size_t j = 0; j < taut_.size(); ++j) {
      tension -= inverse_TT_(ToIndex(i), ToIndex(j)) * cable_motion_m[taut_[j]];
    }
    *effector_motion_m += tension * compliance.W_ea().col(taut_[i]);
  }
}

}  // namespace palpate::force_estimation
