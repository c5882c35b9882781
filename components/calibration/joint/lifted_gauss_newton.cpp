// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/lifted_gauss_newton.hpp"

#include <limits>
#include <utility>

#include "components/calibration/joint/gauss_newton.hpp"

namespace palpate::calibration {

namespace {

/// From the undeformed body it takes five to seven; more say that it wanders.
constexpr int kMostSteps = 12;
/// Of the body's extent: after a shorter way the next step is one with the factor that is there.
/// The derivatives have changed by about as large a share.
constexpr double kShortWay = 1e-4;
/// A chord step that does not shorten the way to this share is followed by one with a new factor.
constexpr double kShortens = 0.1;

/// The problem with bodies that move as their derivatives say.
class Predicted final : public LeastSquaresProblem {
 public:
  Predicted(JointProblem* problem, Eigen::VectorXd start)
      : problem_(problem), start_(std::move(start)) {}

  Eigen::VectorXd Start() const override { return start_; }
  Eigen::MatrixX2d Bounds() const override { return problem_->Bounds(); }
  Eigen::MatrixX2d ConstraintBounds() const override { return problem_->ConstraintBounds(); }
  std::vector<RobustBlock> RobustBlocks() const override { return problem_->RobustBlocks(); }
  Status Evaluate(const Eigen::VectorXd& variables, LeastSquaresPoint* point) override {
    problem_->See(variables, point);
    return Status::Ok();
  }

 private:
  JointProblem* problem_;
  Eigen::VectorXd start_;
};

/// Variables move to where the shapes, as they are linearised, leave the least.
Status MoveVariables(JointProblem* problem, const LeastSquaresSettings& settings,
                     LiftedSolution* lifted_gauss_newton) {
  LeastSquaresPoint point;
  const auto tell = [&](double objective) {
    problem->See(lifted_gauss_newton->variables, &point);
    lifted_gauss_newton->objectives.push_back(objective);
    lifted_gauss_newton->residual_rms_after_m.push_back(problem->ResidualRms_m());
  };
  Predicted predicted(problem, lifted_gauss_newton->variables);
  const LeastSquaresSolution solution = SolveWithinBounds(predicted, settings);
  if (!solution.status.ok()) return solution.status;
  if (lifted_gauss_newton->steps == 0) tell(solution.objectives.front());
  lifted_gauss_newton->variables = solution.variables;
  tell(solution.objectives.back());
  ++lifted_gauss_newton->steps;
  return Status::Ok();
}

/// Until nothing moves; not ok where that does not come.
Status StepUntilStill(JointProblem* problem, const LeastSquaresSettings& settings,
                      LiftedSolution* lifted_gauss_newton) {
  BodyShapes& shapes = problem->shapes();
  if (Status status = shapes.ComeNear(lifted_gauss_newton->variables); !status.ok()) return status;
  double way = std::numeric_limits<double>::infinity();
  while (lifted_gauss_newton->steps < kMostSteps) {
    const bool keep = way < kShortWay && shapes.KeepsFactors();
    Status status = keep ? shapes.LineariseKept(lifted_gauss_newton->variables)
                         : shapes.Linearise(lifted_gauss_newton->variables);
    lifted_gauss_newton->factorisations += keep ? 0 : 1;
    if (status.ok()) status = MoveVariables(problem, settings, lifted_gauss_newton);
    if (!status.ok()) return status;
    const double last = std::exchange(way, shapes.StepTo(lifted_gauss_newton->variables));
    const bool still = way < SolvedState::kTinyMove;
    if (keep && way > kShortens * last) way = std::numeric_limits<double>::infinity();
    if (still && shapes.AreBalanced(lifted_gauss_newton->variables)) return Status::Ok();
  }
  return {StatusCode::kNotConverged, "steps used up"};
}

}  // namespace

LiftedSolution SolveLiftedGaussNewton(JointProblem* problem, const LeastSquaresSettings& settings) {
  LiftedSolution lifted_gauss_newton;
  lifted_gauss_newton.variables = problem->Start();
  lifted_gauss_newton.status = StepUntilStill(problem, settings, &lifted_gauss_newton);
  if (lifted_gauss_newton.status.ok()) {
    problem->shapes().Keep();
    return lifted_gauss_newton;
  }
  problem->shapes().Return();
  LiftedSolution nowhere;
  nowhere.status = lifted_gauss_newton.status;
  return nowhere;
}

}  // namespace palpate::calibration
