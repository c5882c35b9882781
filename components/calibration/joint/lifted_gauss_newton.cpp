// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/lifted_gauss_newton.hpp"

#include <limits>
#include <utility>

#include "components/calibration/joint/gauss_newton.hpp"

namespace palpate::calibration {

namespace {

struct LiftedTuning {
  int most_steps = 12;  ///< five to seven are normal from the undeformed body; more diverge
  /// Nodal displacement over the body's extent after which a chord step follows: the derivatives
  /// have changed by about that share. More saves factorisations and needs more steps.
  double short_way = 1e-4;
  /// A chord step that reduces the displacement by less is followed by a new factor.
  double shortens = 0.1;
};
constexpr LiftedTuning kLiftedTuning;

/// The problem with linearised motion of the bodies.
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

/// Moves the variables to the minimum with linearised shapes.
Status MoveVariables(JointProblem* problem, const LeastSquaresSettings& settings,
                     LiftedSolution* lifted_gauss_newton) {
  LeastSquaresPoint point;
  const auto record = [&](double objective) {
    problem->See(lifted_gauss_newton->variables, &point);
    lifted_gauss_newton->objectives.push_back(objective);
    lifted_gauss_newton->residual_rms_after_m.push_back(problem->ResidualRms_m());
  };
  Predicted predicted(problem, lifted_gauss_newton->variables);
  const LeastSquaresSolution solution = SolveWithinBounds(predicted, settings);
  if (!solution.status.ok()) return solution.status;
  if (lifted_gauss_newton->steps == 0) record(solution.objectives.front());
  lifted_gauss_newton->variables = solution.variables;
  record(solution.objectives.back());
  ++lifted_gauss_newton->steps;
  return Status::Ok();
}

/// Until nothing moves; not ok without convergence.
Status StepUntilStill(JointProblem* problem, const LeastSquaresSettings& settings,
                      LiftedSolution* lifted_gauss_newton) {
  BodyShapes& shapes = problem->shapes();
  if (Status status = shapes.ComeNear(lifted_gauss_newton->variables); !status.ok()) return status;
  double way = std::numeric_limits<double>::infinity();
  while (lifted_gauss_newton->steps < kLiftedTuning.most_steps) {
    const bool keep = way < kLiftedTuning.short_way && shapes.KeepsFactors();
    Status status = keep ? shapes.LineariseKept(lifted_gauss_newton->variables)
                         : shapes.Linearise(lifted_gauss_newton->variables);
    lifted_gauss_newton->factorisations += keep ? 0 : 1;
    if (status.ok()) status = MoveVariables(problem, settings, lifted_gauss_newton);
    if (!status.ok()) return status;
    const double last = std::exchange(way, shapes.StepTo(lifted_gauss_newton->variables));
    const bool still = way < kSolvedStateTuning.tiny_move;
    if (keep && way > kLiftedTuning.shortens * last) way = std::numeric_limits<double>::infinity();
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
  LiftedSolution failed;
  failed.status = lifted_gauss_newton.status;
  return failed;
}

}  // namespace palpate::calibration
