// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/force_qp.hpp"

#include <limits>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::force_estimation {

namespace {

struct ForceQpTuning {
  /// Changes between taut and slack cables in one QP. More serve robots of many cables; each costs
  /// a condensation.
  int most_set_changes = 12;
  /// Directions with less information than this share of the largest have no covariance. Larger
  /// hides uncertain directions, smaller lets rounding pass for information.
  double least_information = 1e-14;
};
constexpr ForceQpTuning kForceQpTuning;

/// Inverse in the directions that have information. Those of infinite variance are not in the
/// basis.
fem::QpMatrix PseudoInverse(const fem::QpMatrix& information) {
  const linalg::SmallSymmetricEigen eigen = linalg::DecomposeSymmetric(information);
  fem::QpMatrix inverse = fem::QpMatrix::Zero(information.rows(), information.cols());
  for (Eigen::Index k = 0; k < information.rows(); ++k) {
    const double value = eigen.values[k];
    if (value <= kForceQpTuning.least_information * eigen.values.maxCoeff()) continue;
    inverse += eigen.vectors.col(k) * eigen.vectors.col(k).transpose() / value;
  }
  return inverse;
}

}  // namespace

ForceQp::ForceQp(int rows, const std::vector<robot::ActuatorTraits>& traits)
    : condensation_(rows, traits), lambda_a_N_(ToIndex(traits.size())) {
  SetSites({});
}

void ForceQp::SetSites(const std::vector<FitSite>& sites) {
  PALPATE_CHECK(3 * sites.size() <= static_cast<size_t>(fem::kMaxQpVariables), sites.size());
  sites_ = sites;
  const auto forces = ToIndex(3 * sites.size());
  lambda_f_N_ = Eigen::VectorXd::Zero(forces);
  prior_information_ = fem::QpMatrix::Zero(forces, forces);
  IncludeAllDirections();
}

void ForceQp::KeepObservable(const RowTargets& targets, double largest_sigma_N) {
  observable_.KeepObservable(sites_, Information(targets), largest_sigma_N);
}

Status ForceQp::Solve(const robot::Compliance& compliance, const RowTargets& targets,
                      const std::vector<robot::ActuatorCommand>& commands,
                      const Eigen::VectorXd& start_lambda_f_N, double damping) {
  const fem::QpMatrix& basis = observable_.basis();
  const Eigen::Index q = basis.cols();
  fem::BoundedQp qp;
  qp.lower = fem::QpVector::Constant(q, -std::numeric_limits<double>::infinity());
  qp.upper = -qp.lower;
  start_ = basis.transpose() * start_lambda_f_N;
  for (int round = 0; round < kForceQpTuning.most_set_changes; ++round) {
    if (Status status = condensation_.Condense(compliance, commands); !status.ok()) return status;
    misfit_m_ = condensation_.e0_m() - targets.value_m;
    qp.H = basis.transpose() * Information(targets) * basis;
    qp.c = basis.transpose() * Projection(targets, misfit_m_);
    if (q > 0) {
      const double hold = damping * qp.H.diagonal().maxCoeff();
      qp.H.diagonal().array() += hold;
      qp.c -= hold * start_;
      const fem::BoundedQpResult solution = fem::SolveBoundedQp(qp, start_);
      if (!solution.status.ok()) return solution.status;
      lambda_f_N_ = basis * solution.x;
    } else {
      lambda_f_N_.setZero();
    }
    if (condensation_.Settle(compliance, commands, lambda_f_N_)) break;
  }
  condensation_.CableForces(lambda_f_N_, &lambda_a_N_);
  return Status::Ok();
}

double ForceQp::ChiSquared(const RowTargets& targets) const {
  const Eigen::VectorXd residual_m =
      targets.value_m - condensation_.e0_m() - condensation_.G() * lambda_f_N_;
  return (residual_m.array().square() * targets.weight.array()).sum();
}

fem::QpMatrix ForceQp::Information(const RowTargets& targets) const {
  const Eigen::MatrixXd& G = condensation_.G();
  fem::QpMatrix information = prior_information_;
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double sum = (G.col(i).array() * G.col(j).array() * targets.weight.array()).sum();
      information(i, j) += sum;
      if (i != j) information(j, i) += sum;
    }
  }
  return information;
}

fem::QpMatrix ForceQp::Covariance_N2(const RowTargets& targets) const {
  const fem::QpMatrix& basis = observable_.basis();
  const fem::QpMatrix reduced = basis.transpose() * Information(targets) * basis;
  return basis * PseudoInverse(reduced) * basis.transpose();
}

/// Forces T t along the tangents T that are not fitted move the rows by G T t. The fit takes that
/// for the forces S G' W G T t, and for t itself none: S the covariance, W the weights. Priors have
/// no part in it, as that of a site does not couple its tangents.
fem::QpMatrix ForceQp::UnfittedError(const RowTargets& targets,
                                     const fem::QpMatrix& covariance_N2) const {
  const fem::QpMatrix& unfitted = observable_.unfitted();
  fem::QpMatrix error = -unfitted;
  if (unfitted.cols() == 0) return error;
  const fem::QpMatrix data = Information(targets) - prior_information_;
  error += covariance_N2 * data * unfitted;
  return error;
}

fem::QpVector ForceQp::Projection(const RowTargets& targets,
                                  const Eigen::Ref<const Eigen::VectorXd>& v_m) const {
  const Eigen::MatrixXd& G = condensation_.G();
  fem::QpVector sums(G.cols());
  for (Eigen::Index j = 0; j < G.cols(); ++j) {
    sums[j] = (G.col(j).array() * targets.weight.array() * v_m.array()).sum();
  }
  return sums;
}

}  // namespace palpate::force_estimation
