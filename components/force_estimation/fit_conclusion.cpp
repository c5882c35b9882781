// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Eigenvalues>

#include "components/force_estimation/marker_fitter.hpp"

namespace palpate::force_estimation {

namespace {

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

/// Residual, covariance and sensitivity of a converged fit.
Status MarkerFitter::Conclude() {
  const MarkerTargets& targets = *frame_.targets;
  const ModelState& state = *frame_.state;
  fit_.chi_squared = ChiSquared(targets, state, &fit_.residual_m);
  if (Status status = CheckTensions(state); !status.ok()) return status;
  const fem::QpMatrix& basis = directions_.basis();
  const fem::QpMatrix reduced = basis.transpose() * Information(targets) * basis;
  fit_.covariance_N2 = basis * PseudoInverse(reduced) * basis.transpose();
  ModulusSensitivity(targets, state);
  last_good_ = state;
  last_good_.valid = true;
  return Status::Ok();
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
    gradient_.setZero();
    model_.cable(c).AddGradient(state.x_m, -1.0, gradient_);
    cable_motion_[c] = gradient_.dot(nodal_);
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
