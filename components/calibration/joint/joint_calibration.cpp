// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/joint_calibration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "components/calibration/joint/determination.hpp"
#include "components/calibration/joint/lifted_gauss_newton.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

/// Holds the variables that are not determined at this point. `held_more`: whether there are any.
Status HoldUndetermined(const LeastSquaresPoint& point, const JointSettings& settings,
                        JointProblem* problem, bool* held_more) {
  *held_more = false;
  for (;;) {
    const auto worst = MostUndetermined(point, *problem, settings.undetermined_share);
    if (!worst) return Status::Ok();
    const Variable& variable = problem->variables()[At(worst->variable)];
    if (IsOfPose(worst->variable, *problem)) {
      return {StatusCode::kUnobservable, "the data do not determine the camera pose (" +
                                             variable.name + "): it needs " +
                                             variable.what_would_tell};
    }
    problem->Hold(worst->variable, worst->sigma);
    *held_more = true;
  }
}

/// The same at a solution, whose residuals tell how well the model fits.
Status HoldUncertain(const LeastSquaresPoint& solution, const JointSettings& settings,
                     JointProblem* problem, bool* held_more) {
  if (Status status = HoldUndetermined(solution, settings, problem, held_more); !status.ok()) {
    return status;
  }
  while (const auto worst = MostUncertainModulus(
             solution, *problem, settings.solver.huber_threshold, settings.undetermined_share)) {
    problem->Hold(worst->variable, worst->sigma);
    *held_more = true;
  }
  return Status::Ok();
}

/// The next search starts there, with held variables at their means.
void StartWithHeld(Eigen::VectorXd from, JointProblem* problem) {
  for (int v = 0; v < static_cast<int>(from.size()); ++v) {
    if (problem->IsHeld(v)) from[v] = 0.0;
  }
  problem->StartAt(from);
}

/// Finds the start of the search, and holds what is not determined there. `starts_there`: the start
/// is nearly the solution.
Status FindStart(JointProblem* problem, const JointSettings& settings,
                 LiftedSolution* lifted_gauss_newton, bool* starts_there) {
  if (problem->CanBeLifted()) {
    *lifted_gauss_newton = SolveLiftedGaussNewton(problem, settings.solver);
    if (lifted_gauss_newton->status.ok()) problem->StartAt(lifted_gauss_newton->variables);
  }
  LeastSquaresPoint start;
  if (Status status = problem->Evaluate(problem->Start(), &start); !status.ok()) return status;
  problem->Accept();
  bool held_more = false;
  Status status = HoldUndetermined(start, settings, problem, &held_more);
  *starts_there = lifted_gauss_newton->status.ok() && !held_more;
  if (held_more) StartWithHeld(problem->Start(), problem);
  return status;
}

Status Solve(JointProblem* problem, const JointSettings& settings,
             LiftedSolution* lifted_gauss_newton, LeastSquaresSolution* solution) {
  LeastSquaresSettings solver = settings.solver;
  Status status = FindStart(problem, settings, lifted_gauss_newton, &solver.starts_there);
  if (!status.ok()) return status;
  for (;;) {
    *solution = SolveLeastSquares(*problem, solver);
    if (!solution->status.ok()) {
      if (!solver.starts_there || solver.stop.stop_requested()) return solution->status;
      solver.starts_there = false;
      continue;
    }
    bool held_more = false;
    status = HoldUncertain(solution->point, settings, problem, &held_more);
    if (!status.ok() || !held_more) return status;
    StartWithHeld(solution->variables, problem);
    solver.starts_there = false;
  }
}

void ReportValues(const JointProblem& problem, const LeastSquaresSolution& solution,
                  const Eigen::MatrixXd& covariance, const JointSettings& settings,
                  JointCalibration* result) {
  std::vector<int> reported;
  for (int v = 0; v < static_cast<int>(problem.variables().size()); ++v) {
    const bool considered = problem.variables()[At(v)].considered;
    if (!IsOfPose(v, problem) && !considered) reported.push_back(v);
  }
  for (const int v : reported) {
    const Variable& variable = problem.variables()[At(v)];
    const double value = problem.ValueOf(v, solution.variables);
    double error = problem.Scale(v) * std::sqrt(covariance(v, v));
    if (problem.IsHeld(v)) error = variable.prior.sigma;
    const Unknown* unknown = variable.unknown;
    const double per_value = unknown != nullptr ? std::abs(unknown->QuantityPerValue(value)) : 1.0;
    error *= per_value;
    const double scale = per_value * problem.Scale(v);
    result->values.push_back(
        {.name = variable.name,
         .unit = variable.unit,
         .value = unknown != nullptr ? unknown->Quantity(value) : value,
         .prior_mean =
             unknown != nullptr ? unknown->Quantity(variable.prior.mean) : variable.prior.mean,
         .standard_error = error,
         .determined = !problem.IsHeld(v),
         .reached_error = scale * problem.ReachedWhenHeld(v),
         .error_limit = scale * settings.undetermined_share,
         .what_would_tell = problem.IsHeld(v) ? variable.what_would_tell : std::string()});
  }
  const auto count = ToIndex(reported.size());
  result->correlation.setZero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const int a = reported[At(i)];
      const int b = reported[At(j)];
      const double product = covariance(a, a) * covariance(b, b);
      if (product > 0.0) result->correlation(i, j) = covariance(a, b) / std::sqrt(product);
    }
  }
}

/// `covariance`: against the truth; `against_model`: against this model.
FittedCamera CameraOf(const JointProblem& problem, int camera, const Eigen::VectorXd& variables,
                      const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& against_model) {
  FittedCamera found{.T_robot_camera = problem.PoseAt(variables, camera)};
  const bool biased = problem.EstimatesDepthBias(camera);
  const int count = biased ? geometry::CountOf(problem.depth_bias(camera)->basis) : 0;
  Eigen::MatrixXd per_variable = Eigen::MatrixXd::Zero(6 + count, covariance.cols());
  for (int i = 0; i < 6 && problem.pose_column(camera) >= 0; ++i) {
    const int v = problem.pose_column(camera) + i;
    per_variable(i, v) = problem.Scale(v);
  }
  Eigen::VectorXd coefficients(count);
  for (int k = 0; k < count; ++k) {
    const int v = problem.depth_bias_column(camera) + k;
    coefficients[k] = problem.ValueOf(v, variables);
    per_variable(6 + k, v) = problem.Scale(v);
  }
  const Eigen::MatrixXd both = per_variable * covariance * per_variable.transpose();
  found.pose_covariance = both.topLeftCorner<6, 6>();
  if (!biased) return found;
  found.pose_and_bias_covariance = both;
  geometry::DepthBiasMap& map = found.depth_bias.emplace();
  map.basis = problem.depth_bias(camera)->basis;
  map.coefficients = coefficients;
  map.covariance = per_variable * against_model * per_variable.transpose();
  return found;
}

void ReportCameras(const JointProblem& problem, const Eigen::VectorXd& variables,
                   const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& against_model,
                   JointCalibration* result) {
  const auto of = [&](int camera) {
    return CameraOf(problem, camera, variables, covariance, against_model);
  };
  static_cast<FittedCamera&>(*result) = of(0);
  for (int camera = 1; camera < problem.CameraCount(); ++camera)
    result->further_cameras.push_back(of(camera));
}

/// Objective and residual of each iteration. The lifted method ends where Ipopt starts.
void ReportIterations(const JointProblem& problem, const LiftedSolution& lifted_gauss_newton,
                      const LeastSquaresSolution& solution, JointCalibration* result) {
  result->iterations = lifted_gauss_newton.steps + solution.iterations;
  result->objectives = lifted_gauss_newton.objectives;
  result->residual_rms_after_m = lifted_gauss_newton.residual_rms_after_m;
  const std::vector<double>& accepted_m = problem.residual_rms_after_m();
  const std::size_t reported = lifted_gauss_newton.steps > 0 ? 1 : 0;
  const auto since = std::min(accepted_m.size(), solution.objectives.size()) - reported;
  for (std::size_t k = since; k > 0; --k) {
    result->objectives.push_back(solution.objectives[solution.objectives.size() - k]);
    result->residual_rms_after_m.push_back(accepted_m[accepted_m.size() - k]);
  }
}

void Conclude(const JointProblem& problem, const LeastSquaresSolution& solution,
              const JointSettings& settings, JointCalibration* result) {
  result->residual_rms_of_frame_m = problem.residual_rms_m();
  result->marker_residuals_m = problem.marker_residuals_m();
  double squares_m2 = 0.0;
  for (const double rms_m : result->residual_rms_of_frame_m) squares_m2 += rms_m * rms_m;
  result->residual_rms_m =
      std::sqrt(squares_m2 / static_cast<double>(result->residual_rms_of_frame_m.size()));
  const WeightedFit fit = Weigh(problem, solution.point, settings.solver.huber_threshold);
  result->chi_squared = fit.chi_squared;
  result->degrees_of_freedom = DegreesOfFreedom(problem);
  const double widened = WidenedBy(fit, result->degrees_of_freedom);
  const Eigen::MatrixXd covariance = CovarianceOf(fit, problem, widened);
  ReportCameras(problem, solution.variables, covariance,
                CovarianceOf(fit, problem, widened, Against::kThisModel), result);
  result->adjusted_poses = problem.AdjustedPosesAt(solution.variables);
  result->x_m = problem.ShapesAt(solution.variables);
  ReportValues(problem, solution, covariance, settings, result);
}

}  // namespace

JointCalibration CalibrateJointly(robot::RobotModel& model, const JointSetup& setup,
                                  const JointSettings& settings) {
  const ModelSnapshot kept(model);
  JointCalibration result;
  JointProblem problem(model, setup);
  LeastSquaresSolution solution;
  LiftedSolution lifted_gauss_newton;
  result.status = Solve(&problem, settings, &lifted_gauss_newton, &solution);
  if (!result.status.ok()) {
    kept.Restore();
    return result;
  }
  ReportIterations(problem, lifted_gauss_newton, solution, &result);
  Conclude(problem, solution, settings, &result);
  kept.RestoreGravity();
  return result;
}

}  // namespace palpate::calibration
