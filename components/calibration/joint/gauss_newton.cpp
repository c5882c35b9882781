// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/gauss_newton.hpp"

#include <utility>
#include <vector>

#include "components/calibration/joint/robust_loss.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::calibration {

namespace {

struct GaussNewtonTuning {
  /// Added to the Hessian's diagonal, so that undetermined variables stay: more slows the others.
  double damping = 1e-6;
  double shortest_step = 1e-3;  ///< share of the full step; less tries longer for a lower objective
};
constexpr GaussNewtonTuning kGaussNewtonTuning;

class Descent {
 public:
  Descent(LeastSquaresProblem& problem, const LeastSquaresSettings& settings)
      : problem_(problem),
        settings_(settings),
        bounds_(problem.Bounds()),
        blocks_(problem.RobustBlocks()) {
    solution_.variables = problem.Start().cwiseMax(bounds_.col(0)).cwiseMin(bounds_.col(1));
  }

  LeastSquaresSolution Run() {
    Status status = problem_.Evaluate(solution_.variables, &solution_.point);
    if (!status.ok()) return Ended(std::move(status));
    loss_ = LossOf(solution_.point.residual, blocks_, settings_.huber_threshold);
    solution_.objectives.push_back(loss_.objective);
    while (solution_.iterations < settings_.max_iterations) {
      if (settings_.stop.stop_requested()) break;
      const double moved = Step();
      if (moved <= settings_.step_tolerance) return Ended(Status::Ok());
    }
    return Ended({StatusCode::kNotConverged, "Gauss-Newton steps used up"});
  }

 private:
  /// Largest change of a variable; 0 where no step lowers the objective.
  double Step() {
    ++solution_.iterations;
    if (settings_.iterations != nullptr) ++*settings_.iterations;
    const Eigen::VectorXd step = FullStep();
    LeastSquaresPoint point;
    for (double length = 1.0; length >= kGaussNewtonTuning.shortest_step; length *= 0.5) {
      const Eigen::VectorXd variables =
          (solution_.variables + length * step).cwiseMax(bounds_.col(0)).cwiseMin(bounds_.col(1));
      if (!problem_.Evaluate(variables, &point).ok()) continue;
      RobustLoss loss = LossOf(point.residual, blocks_, settings_.huber_threshold);
      if (!(loss.objective < loss_.objective)) continue;
      const double moved = (variables - solution_.variables).lpNorm<Eigen::Infinity>();
      solution_.variables = variables;
      solution_.point = std::move(point);
      loss_ = std::move(loss);
      solution_.objectives.push_back(loss_.objective);
      return moved;
    }
    return 0.0;
  }

  /// Step of the variables that the gradient does not push against a bound.
  Eigen::VectorXd FullStep() const {
    const Eigen::MatrixXd& jacobian = solution_.point.jacobian;
    const Eigen::VectorXd gradient =
        jacobian.transpose() * loss_.weights.cwiseProduct(solution_.point.residual);
    std::vector<Eigen::Index> free;
    for (Eigen::Index v = 0; v < gradient.size(); ++v) {
      const bool at_lower = solution_.variables[v] <= bounds_(v, 0);
      const bool at_upper = solution_.variables[v] >= bounds_(v, 1);
      const bool pushed = (at_lower && gradient[v] >= 0.0) || (at_upper && gradient[v] <= 0.0);
      if (!pushed && !(at_lower && at_upper)) free.push_back(v);
    }
    const Eigen::MatrixXd moving = jacobian(Eigen::all, free);
    Eigen::MatrixXd hessian = moving.transpose() * loss_.weights.asDiagonal() * moving;
    hessian.diagonal().array() += kGaussNewtonTuning.damping;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient.size());
    step(free) = -linalg::SolveSymmetric(hessian, Eigen::VectorXd(gradient(free)));
    return step;
  }

  LeastSquaresSolution Ended(Status status) {
    solution_.status = std::move(status);
    return std::move(solution_);
  }

  LeastSquaresProblem& problem_;
  const LeastSquaresSettings& settings_;
  const Eigen::MatrixX2d bounds_;
  const std::vector<RobustBlock> blocks_;
  RobustLoss loss_;
  LeastSquaresSolution solution_;
};

}  // namespace

LeastSquaresSolution SolveWithinBounds(LeastSquaresProblem& problem,
                                       const LeastSquaresSettings& settings) {
  return Descent(problem, settings).Run();
}

}  // namespace palpate::calibration
