// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/determination.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "components/calibration/joint/robust_loss.hpp"
#include "libs/core/index.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::calibration {

namespace {

int CountOf(const JointProblem& problem) { return static_cast<int>(problem.variables().size()); }

Eigen::MatrixXd Pick(const Eigen::MatrixXd& matrix, const std::vector<int>& rows,
                     const std::vector<int>& columns) {
  Eigen::MatrixXd picked(std::ssize(rows), std::ssize(columns));
  for (Eigen::Index i = 0; i < picked.rows(); ++i) {
    for (Eigen::Index j = 0; j < picked.cols(); ++j) {
      picked(i, j) = matrix(rows[At(i)], columns[At(j)]);
    }
  }
  return picked;
}

Eigen::MatrixXd Pick(const Eigen::MatrixXd& matrix, const std::vector<int>& chosen) {
  return Pick(matrix, chosen, chosen);
}

/// A pose with a prior is never held: where the data tell nothing, the prior stays.
bool IsMeasuredPose(int variable, const JointProblem& problem) {
  return IsOfPose(variable, problem) &&
         std::isfinite(problem.variables()[At(variable)].prior.sigma);
}

}  // namespace

bool IsOfPose(int variable, const JointProblem& problem) {
  return problem.variables()[At(variable)].of_pose;
}

bool EstimatesAnyDepthBias(const JointProblem& problem) {
  for (int camera = 0; camera < problem.CameraCount(); ++camera) {
    if (problem.EstimatesDepthBias(camera)) return true;
  }
  return false;
}

/// Additional variances of `free` by the considered variables.
Eigen::VectorXd ShiftVariance(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& inverse,
                              const std::vector<int>& free, const JointProblem& problem) {
  std::vector<int> considered;
  for (int v = 0; v < CountOf(problem); ++v) {
    if (problem.variables()[At(v)].considered) considered.push_back(v);
  }
  const Eigen::MatrixXd information =
      jacobian(Eigen::all, free).transpose() * jacobian(Eigen::all, considered);
  return (inverse * information).rowwise().squaredNorm();
}

/// Variables are scaled by min(sigma, plausible), so that each has the prior variance 1.
std::optional<UndeterminedVariable> MostUndetermined(const LeastSquaresPoint& point,
                                                     const JointProblem& problem, double share) {
  std::vector<int> free;
  for (int v = 0; v < CountOf(problem); ++v) {
    if (!problem.IsHeld(v)) free.push_back(v);
  }
  const auto data = point.jacobian.topRows(problem.DataRows());
  Eigen::MatrixXd information = Pick(data.transpose() * data, free);
  information.diagonal().array() += 1.0;
  const Eigen::MatrixXd inverse = linalg::InverseSymmetric(information);
  const Eigen::VectorXd variance = inverse.diagonal();
  std::optional<int> worst;
  double worst_sigma = 0.0;
  for (const bool pose : {false, true}) {
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (IsOfPose(free[k], problem) != pose || IsMeasuredPose(free[k], problem)) continue;
      const double sigma = std::sqrt(variance[ToIndex(k)]);
      if (sigma <= share || sigma <= worst_sigma) continue;
      worst = free[k];
      worst_sigma = sigma;
    }
    if (worst) return UndeterminedVariable{*worst, worst_sigma};
  }
  if (!EstimatesAnyDepthBias(problem)) return std::nullopt;
  const Eigen::VectorXd total =
      variance + ShiftVariance(point.jacobian.topRows(problem.DataRows()), inverse, free, problem);
  double worst_total = 1.0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double of_this = total[ToIndex(k)];
    const bool of_bias = problem.variables()[At(free[k])].of_depth_bias;
    if (!of_bias || of_this <= worst_total) continue;
    worst = free[k];
    worst_total = of_this;
  }
  if (!worst) return std::nullopt;
  return UndeterminedVariable{*worst, std::sqrt(worst_total)};
}

std::optional<UndeterminedVariable> MostUncertainModulus(const LeastSquaresPoint& point,
                                                         const JointProblem& problem,
                                                         double huber_threshold, double share) {
  const WeightedFit fit = Weigh(problem, point, huber_threshold);
  const Eigen::MatrixXd covariance =
      CovarianceOf(fit, problem, WidenedBy(fit, DegreesOfFreedom(problem)));
  std::optional<UndeterminedVariable> worst;
  for (int v = 0; v < CountOf(problem); ++v) {
    const Unknown* unknown = problem.variables()[At(v)].unknown;
    if (problem.IsHeld(v) || unknown == nullptr || !unknown->IsModulus()) continue;
    const double sigma = std::sqrt(covariance(v, v));
    if (sigma > (worst ? worst->sigma : share)) worst = UndeterminedVariable{v, sigma};
  }
  return worst;
}

int DegreesOfFreedom(const JointProblem& problem) {
  int free = 0;
  for (int v = 0; v < CountOf(problem); ++v) {
    free += problem.IsHeld(v) || std::isfinite(problem.variables()[At(v)].prior.sigma) ? 0 : 1;
  }
  return static_cast<int>(problem.DataRows()) - free;
}

double WidenedBy(const WeightedFit& fit, int degrees_of_freedom) {
  return std::max(1.0, fit.chi_squared / std::max(1, degrees_of_freedom));
}

WeightedFit Weigh(const JointProblem& problem, const LeastSquaresPoint& point,
                  double huber_threshold) {
  const Eigen::VectorXd weight =
      LossOf(point.residual, problem.RobustBlocks(), huber_threshold).weights;
  WeightedFit fit;
  fit.information = point.jacobian.transpose() * weight.asDiagonal() * point.jacobian;
  const Eigen::Index rows = problem.DataRows();
  fit.chi_squared = (weight.head(rows).array() * point.residual.head(rows).array().square()).sum();
  return fit;
}

Eigen::MatrixXd CovarianceOf(const WeightedFit& fit, const JointProblem& problem, double widened,
                             Against against) {
  std::vector<int> estimated, considered;
  for (int v = 0; v < CountOf(problem); ++v) {
    const Variable& variable = problem.variables()[At(v)];
    if (!problem.IsHeld(v)) {
      estimated.push_back(v);
    } else if (std::isfinite(variable.prior.sigma) &&
               !(variable.models_own && against == Against::kThisModel)) {
      considered.push_back(v);
    }
  }
  const Eigen::MatrixXd inverse = linalg::InverseSymmetric(Pick(fit.information, estimated));
  Eigen::VectorXd sigma(std::ssize(considered));
  for (Eigen::Index k = 0; k < sigma.size(); ++k) {
    const int v = considered[At(k)];
    sigma[k] = problem.variables()[At(v)].prior.sigma / problem.Scale(v);
  }
  // Shift of the estimates by one standard deviation of each considered variable.
  const Eigen::MatrixXd shift =
      -inverse * Pick(fit.information, estimated, considered) * sigma.asDiagonal();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(CountOf(problem), CountOf(problem));
  covariance(estimated, estimated) = widened * inverse + shift * shift.transpose();
  covariance(estimated, considered) = shift * sigma.asDiagonal();
  covariance(considered, estimated) = covariance(estimated, considered).transpose();
  covariance(considered, considered) = sigma.cwiseAbs2().asDiagonal();
  return covariance;
}

}  // namespace palpate::calibration
