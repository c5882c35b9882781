// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/force_fitter.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::force_estimation {

namespace {

/// Inverse on the directions that have information; infinite variances are left out by the basis.
fem::QpMatrix PseudoInverse(const fem::QpMatrix& information) {
  const linalg::SmallSymmetricEigen eigen = linalg::DecomposeSymmetric(information);
  fem::QpMatrix inverse = fem::QpMatrix::Zero(information.rows(), information.cols());
  for (Eigen::Index k = 0; k < information.rows(); ++k) {
    const double value = eigen.values[k];
    if (value <= 1e-14 * eigen.values.maxCoeff()) continue;
    inverse += eigen.vectors.col(k) * eigen.vectors.col(k).transpose() / value;
  }
  return inverse;
}

}  // namespace

/// Residual, covariance and sensitivity of a converged fit.
Status ForceFitter::Conclude() {
  const RowTargets& targets = *frame_.targets;
  const ModelState& state = *frame_.state;
  fit_.chi_squared = ChiSquared(targets, state, &fit_.residual_m);
  if (Status status = CheckTensions(state); !status.ok()) return status;
  const fem::QpMatrix& basis = directions_.basis();
  const fem::QpMatrix reduced = basis.transpose() * Information(targets) * basis;
  fit_.covariance_N2 = basis * PseudoInverse(reduced) * basis.transpose();
  if (tell_modulus_sensitivity_) ModulusSensitivity(targets, state);
  last_good_ = state;
  last_good_.valid = true;
  return Status::Ok();
}

Status ForceFitter::CheckTensions(const ModelState& state) const {
  for (int c = 0; c < model_.CableCount(); ++c) {
    const double tension_N = state.lambda_a_N[c];
    if (tension_N < -most_push_N_) return {StatusCode::kNotConverged, {}};
    if (tension_N > model_.body().cables[static_cast<size_t>(c)].max_tension_N) {
      return {StatusCode::kTensionLimit, {}};
    }
  }
  return Status::Ok();
}

/// With stiffer material the same shape needs larger forces: internal forces grow with ln E, and
/// the fit answers by dlambda_f = -(G' S^-1 G)^-1 G' S^-1 de/dlnE.
void ForceFitter::ModulusSensitivity(const RowTargets& targets, const ModelState& state) {
  nodal_.setZero();
  model_.elastic_body().AddForces(state.x_m, nodal_);
  nodal_ *= -1.0;
  RespondTo(nodal_, state.x_m, &response_motion_m_);
  const Eigen::MatrixXd& G = elimination_.G();
  fem::QpVector pull(G.cols());
  for (Eigen::Index j = 0; j < G.cols(); ++j) {
    pull[j] = (G.col(j).array() * targets.weight.array() * response_motion_m_.col(0).array()).sum();
  }
  fit_.modulus_sensitivity_N.noalias() = -fit_.covariance_N2 * pull;
}

void ForceFitter::RespondTo(const Eigen::Ref<const Eigen::MatrixXd>& forces_N,
                            const Eigen::VectorXd& x_m, Eigen::MatrixXd* row_motions_m) {
  const fem::StiffnessMatrix& matrix = model_.linearisation().matrix();
  responses_.resize(matrix.Size(), forces_N.cols());
  for (Eigen::Index k = 0; k < forces_N.cols(); ++k) {
    matrix.Reduce(forces_N.col(k), responses_.col(k));
  }
  model_.linearisation().SolveSingle(responses_);
  work_ += kColumnsWork;
  row_motions_m->resize(static_cast<Eigen::Index>(rows().size()), forces_N.cols());
  for (Eigen::Index k = 0; k < forces_N.cols(); ++k) {
    gradient_.setZero();
    matrix.AddExpanded(responses_.col(k), 1.0, gradient_);
    for (size_t r = 0; r < rows().size(); ++r) {
      effector_motion_[static_cast<Eigen::Index>(r)] = rows()[r].Value(gradient_);
    }
    for (int c = 0; c < model_.CableCount(); ++c) {
      cable_gradient_.setZero();
      model_.cable(c).AddGradient(x_m, -1.0, cable_gradient_);
      cable_motion_[c] = cable_gradient_.dot(gradient_);
    }
    elimination_.HoldTautCables(compliance_, cable_motion_, &effector_motion_);
    row_motions_m->col(k) = effector_motion_;
  }
}

}  // namespace palpate::force_estimation
