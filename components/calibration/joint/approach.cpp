// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/approach.hpp"

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
                     Approach* approach) {
  LeastSquaresPoint point;
  const auto tell = [&](double objective) {
    problem->See(approach->variables, &point);
    approach->objectives.push_back(objective);
    approach->residual_rms_after_m.push_back(problem->ResidualRms_m());
  };
  Predicted predicted(problem, approach->variables);
  const LeastSquaresSolution solution = SolveWithinBounds(predicted, settings);
  if (!solution.status.ok()) return solution.status;
  if (approach->steps == 0) tell(solution.objectives.front());
  approach->variables = solution.variables;
  tell(solution.objectives.back());
  ++approach->steps;
  return Status::Ok();
}

/// Until nothing moves; not ok where that does not come.
Status StepUntilStill(JointProblem* problem, const LeastSquaresSettings& settings,
                      Approach* approach) {
  BodyShapes& shapes = problem->shapes();
  if (Status status = shapes.ComeNear(approach->variables); !status.ok()) return status;
  double way = std::numeric_limits<double>::infinity();
  while (approach->steps < kMostSteps) {
    const bool keep = way < kShortWay && shapes.KeepsFactors();
    Status status =
        keep ? shapes.LineariseKept(approach->variables) : shapes.Linearise(approach->variables);
    approach->factorisations += keep ? 0 : 1;
    if (status.ok()) status = MoveVariables(problem, settings, approach);
    if (!status.ok()) return status;
    const double last = std::exchange(way, shapes.StepTo(approach->variables));
    const bool still = way < SolvedState::kTinyMove;
    if (keep && way > kShortens * last) way = std::numeric_limits<double>::infinity();
    if (still && shapes.AreBalanced(approach->variables)) return Status::Ok();
  }
  return {StatusCode::kNotConverged, "steps used up"};
}

}  // namespace

Approach ApproachSolution(JointProblem* problem, const LeastSquaresSettings& settings) {
  Approach approach;
  approach.variables = problem->Start();
  approach.status = StepUntilStill(problem, settings, &approach);
  if (approach.status.ok()) {
    problem->shapes().Keep();
    return approach;
  }
  problem->shapes().Return();
  Approach nowhere;
  nowhere.status = approach.status;
  return nowhere;
}

}  // namespace palpate::calibration
