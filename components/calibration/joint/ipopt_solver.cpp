// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/ipopt_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "components/calibration/joint/robust_loss.hpp"
#include "libs/core/check.hpp"

namespace palpate::calibration {

namespace {

using Ipopt::Index;
using Ipopt::Number;
using VectorMap = Eigen::Map<const Eigen::VectorXd>;

constexpr double kIpoptInfinity = 2e19;

/// Larger gains and less patience end the search earlier, before the minimum.
struct IpoptTuning {
  double no_gradient = 1e-12;   ///< Ipopt's own tolerance, practically off
  double no_gain = 1e-5;        ///< of half of chi-squared: below a hundredth of a standard error
  double no_gain_share = 1e-6;  ///< the same as a share, for data without noise
  /// Iterations without gain that end the search: at a kink of the objective it goes up and down,
  /// and Ipopt's watchdog allows three.
  int patience = 5;
  double no_barrier = 1e-10;  ///< barrier, and distance from the bounds, of a start at the solution
};
constexpr IpoptTuning kIpoptTuning;

/// Held variables do not count: Ipopt eliminates them.
bool HasBounds(const Eigen::MatrixX2d& bounds) {
  const auto is_free = bounds.col(0).array() < bounds.col(1).array();
  return (is_free && bounds.array().isFinite().rowwise().any()).any();
}

/// Adapter of the problem to Ipopt. Values and derivatives are evaluated together, once per point.
class Nlp final : public Ipopt::TNLP {
 public:
  Nlp(LeastSquaresProblem& problem, const LeastSquaresSettings& settings)
      : problem_(problem),
        settings_(settings),
        start_(problem.Start()),
        bounds_(problem.Bounds()),
        constraint_bounds_(problem.ConstraintBounds()),
        blocks_(problem.RobustBlocks()),
        has_bounds_(HasBounds(bounds_) || constraint_bounds_.rows() > 0) {}

  LeastSquaresSolution& solution() { return solution_; }
  bool arrived() const { return arrived_; }

  bool get_nlp_info(Index& n, Index& m, Index& nonzeros_jacobian, Index& nonzeros_hessian,
                    IndexStyleEnum& style) override {
    n = static_cast<Index>(start_.size());
    m = static_cast<Index>(constraint_bounds_.rows());
    nonzeros_jacobian = n * m;
    nonzeros_hessian = n * (n + 1) / 2;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* lower_g,
                       Number* upper_g) override {
    Copy(bounds_, n, lower, upper);
    Copy(constraint_bounds_, m, lower_g, upper_g);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    Eigen::Map<Eigen::VectorXd>(x, n) = start_;
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    if (!Visit(VectorMap(x, n))) return false;
    value = loss_.objective;
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    if (!Visit(VectorMap(x, n))) return false;
    Eigen::Map<Eigen::VectorXd>(gradient, n) =
        point_.jacobian.transpose() * loss_.weights.cwiseProduct(point_.residual);
    return true;
  }

  bool eval_g(Index n, const Number* x, bool, Index m, Number* values) override {
    if (m == 0) return true;
    if (!Visit(VectorMap(x, n))) return false;
    Eigen::Map<Eigen::VectorXd>(values, m) = point_.constraint;
    return true;
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index m, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (m == 0) return true;
    if (values != nullptr && !Visit(VectorMap(x, n))) return false;
    for (Index i = 0, k = 0; i < m; ++i) {
      for (Index j = 0; j < n; ++j, ++k) {
        if (values != nullptr) {
          values[k] = point_.constraint_jacobian(i, j);
        } else {
          rows[k] = i;
          columns[k] = j;
        }
      }
    }
    return true;
  }

  /// Gauss-Newton Hessian of the residuals; constraints are nearly linear and count as such.
  bool eval_h(Index n, const Number* x, bool, Number factor, Index, const Number*, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    if (values != nullptr) {
      if (!Visit(VectorMap(x, n))) return false;
      hessian_ = point_.jacobian.transpose() * loss_.weights.asDiagonal() * point_.jacobian;
    }
    for (Index i = 0, k = 0; i < n; ++i) {
      for (Index j = 0; j <= i; ++j, ++k) {
        if (values != nullptr) {
          values[k] = factor * hessian_(i, j);
        } else {
          rows[k] = i;
          columns[k] = j;
        }
      }
    }
    return true;
  }

  /// The gradient of a chi-squared has no natural scale. The search ends by the size of its steps,
  /// or where they gain nothing: at a kink, as where a cable becomes slack, steps never become
  /// small.
  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number objective,
                             Number infeasibility, Number, Number barrier, Number step, Number,
                             Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    problem_.Accept();
    solution_.iterations = static_cast<int>(iteration);
    if (settings_.iterations != nullptr) ++*settings_.iterations;
    solution_.objectives.push_back(objective);
    const double tolerance = settings_.step_tolerance;
    const bool is_allowed = infeasibility <= tolerance && (!has_bounds_ || barrier <= tolerance);
    if (is_allowed) NoteGain(objective);
    const bool is_still = iteration > 0 && step <= tolerance;
    ends_at_lowest_ = !is_still && idle_iterations_ >= kIpoptTuning.patience;
    arrived_ = is_allowed && (is_still || ends_at_lowest_);
    return !arrived_ && !settings_.stop.stop_requested();
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    solution_.variables = ends_at_lowest_ ? lowest_ : Eigen::VectorXd(VectorMap(x, n));
    if (Visit(solution_.variables)) solution_.point = point_;
  }

 private:
  /// Of the iterate, which was evaluated last.
  void NoteGain(double objective) {
    const double worth =
        std::min(kIpoptTuning.no_gain, kIpoptTuning.no_gain_share * std::abs(objective));
    idle_iterations_ = lowest_objective_ - objective > worth ? 0 : idle_iterations_ + 1;
    if (objective >= lowest_objective_) return;
    lowest_objective_ = objective;
    lowest_ = visited_;
  }

  static void Copy(const Eigen::MatrixX2d& bounds, Index n, Number* lower, Number* upper) {
    for (Index i = 0; i < n; ++i) {
      lower[i] = std::max(bounds(i, 0), -kIpoptInfinity);
      upper[i] = std::min(bounds(i, 1), kIpoptInfinity);
    }
  }

  bool Visit(const Eigen::VectorXd& x) {
    if (x.size() == visited_.size() && (x.array() == visited_.array()).all()) return has_value_;
    visited_ = x;
    const Status status = problem_.Evaluate(x, &point_);
    has_value_ = status.ok() && point_.residual.allFinite() && point_.jacobian.allFinite();
    if (has_value_) {
      loss_ = LossOf(point_.residual, blocks_, settings_.huber_threshold);
    } else {
      solution_.failed_evaluation = status.message();
    }
    return has_value_;
  }

  LeastSquaresProblem& problem_;
  const LeastSquaresSettings& settings_;
  const Eigen::VectorXd start_;
  const Eigen::MatrixX2d bounds_;
  const Eigen::MatrixX2d constraint_bounds_;
  const std::vector<RobustBlock> blocks_;
  const bool has_bounds_;
  bool arrived_ = false;
  double lowest_objective_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd lowest_;
  bool ends_at_lowest_ = false;
  int idle_iterations_ = 0;
  Eigen::VectorXd visited_;
  bool has_value_ = false;
  LeastSquaresPoint point_;
  RobustLoss loss_;
  Eigen::MatrixXd hessian_;
  LeastSquaresSolution solution_;
};

void SetOptions(const LeastSquaresSettings& settings, Ipopt::OptionsList* options) {
  options->SetStringValue("sb", "yes");
  options->SetIntegerValue("print_level", 0);
  options->SetIntegerValue("max_iter", settings.max_iterations);
  options->SetNumericValue("tol", kIpoptTuning.no_gradient);
  options->SetNumericValue("acceptable_tol", kIpoptTuning.no_gradient);
  // Variables are scaled and residuals whitened.
  options->SetStringValue("nlp_scaling_method", "none");
  if (settings.starts_there) {
    options->SetNumericValue("mu_init", kIpoptTuning.no_barrier);
    options->SetNumericValue("bound_push", kIpoptTuning.no_barrier);
    options->SetNumericValue("bound_frac", kIpoptTuning.no_barrier);
    options->SetStringValue("bound_mult_init_method", "mu-based");
  } else {
    options->SetStringValue("mu_strategy", "adaptive");
  }
  // Bounds are strict: no cable pushes.
  options->SetNumericValue("bound_relax_factor", 0.0);
}

}  // namespace

LeastSquaresSolution SolveLeastSquares(LeastSquaresProblem& problem,
                                       const LeastSquaresSettings& settings) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt =
      new Ipopt::IpoptApplication(/*create_console_out=*/false);
  SetOptions(settings, Ipopt::GetRawPtr(ipopt->Options()));
  const Ipopt::ApplicationReturnStatus ready = ipopt->Initialize("");
  PALPATE_CHECK(ready == Ipopt::Solve_Succeeded, static_cast<int>(ready));
  const Ipopt::SmartPtr<Nlp> nlp = new Nlp(problem, settings);
  const Ipopt::ApplicationReturnStatus ended = ipopt->OptimizeTNLP(Ipopt::GetRawPtr(nlp));
  LeastSquaresSolution solution = std::move(nlp->solution());
  const bool arrived = nlp->arrived() || ended == Ipopt::Solve_Succeeded;
  if (arrived && solution.point.residual.size() > 0) {
    solution.status = Status::Ok();
  } else {
    std::string reason = "Ipopt ended with code " + std::to_string(static_cast<int>(ended));
    if (!solution.failed_evaluation.empty()) reason += "; " + solution.failed_evaluation;
    solution.status = Status(StatusCode::kNotConverged, std::move(reason));
  }
  return solution;
}

}  // namespace palpate::calibration
