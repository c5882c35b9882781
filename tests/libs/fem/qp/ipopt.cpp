// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/qp/ipopt.hpp"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>

#include "libs/core/check.hpp"

namespace palpate::fem::qp {

namespace {

using ::Ipopt::Index;
using ::Ipopt::Number;

/// What Ipopt asks for, in its own words.
class Problem final : public ::Ipopt::TNLP {
 public:
  explicit Problem(const BoundedQp& qp) : qp_(qp), n_(static_cast<Index>(qp.c.size())) {}

  const QpVector& solution() const { return solution_; }

  bool get_nlp_info(Index& n, Index& m, Index& nonzeros_jacobian, Index& nonzeros_hessian,
                    IndexStyleEnum& style) override {
    n = n_;
    m = 0;
    nonzeros_jacobian = 0;
    nonzeros_hessian = n_ * (n_ + 1) / 2;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index, Number*, Number*) override {
    constexpr double kIpoptInfinity = 2e19;
    for (Index i = 0; i < n; ++i) {
      lower[i] = std::max(qp_.lower[i], -kIpoptInfinity);
      upper[i] = std::min(qp_.upper[i], kIpoptInfinity);
    }
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    for (Index i = 0; i < n; ++i) x[i] = std::clamp(0.0, qp_.lower[i], qp_.upper[i]);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = Objective(qp_, Eigen::Map<const Eigen::VectorXd>(x, n));
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    Eigen::Map<Eigen::VectorXd>(gradient, n) =
        qp_.H * Eigen::Map<const Eigen::VectorXd>(x, n) + qp_.c;
    return true;
  }

  bool eval_g(Index, const Number*, bool, Index, Number*) override { return true; }

  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index*, Index*, Number*) override {
    return true;
  }

  bool eval_h(Index n, const Number*, bool, Number factor, Index, const Number*, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    for (Index i = 0, k = 0; i < n; ++i) {
      for (Index j = 0; j <= i; ++j, ++k) {
        if (values != nullptr) {
          values[k] = factor * qp_.H(i, j);
        } else {
          rows[k] = i;
          columns[k] = j;
        }
      }
    }
    return true;
  }

  void finalize_solution(::Ipopt::SolverReturn, Index n, const Number* x, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const ::Ipopt::IpoptData*, ::Ipopt::IpoptCalculatedQuantities*) override {
    solution_ = Eigen::Map<const Eigen::VectorXd>(x, n);
  }

 private:
  const BoundedQp qp_;
  const Index n_;
  QpVector solution_;
};

}  // namespace

double Objective(const BoundedQp& qp, const QpVector& x) {
  return 0.5 * x.dot(qp.H * x) + qp.c.dot(x);
}

struct Ipopt::Application {
  ::Ipopt::SmartPtr<::Ipopt::IpoptApplication> ipopt;
};

Ipopt::Ipopt() : application_(std::make_unique<Application>()) {
  application_->ipopt = new ::Ipopt::IpoptApplication(/*create_console_out=*/false);
  ::Ipopt::OptionsList& options = *application_->ipopt->Options();
  options.SetStringValue("sb", "yes");
  options.SetIntegerValue("print_level", 0);
  options.SetStringValue("hessian_constant", "yes");
  options.SetNumericValue("tol", 1e-10);
  options.SetNumericValue("acceptable_tol", 1e-10);
  // Nothing outside the bounds: an objective below the minimum would not be an answer.
  options.SetNumericValue("bound_relax_factor", 0.0);
  const ::Ipopt::ApplicationReturnStatus status = application_->ipopt->Initialize("");
  PALPATE_CHECK(status == ::Ipopt::Solve_Succeeded, static_cast<int>(status));
}

Ipopt::~Ipopt() = default;

std::optional<QpVector> Ipopt::Solve(const BoundedQp& qp) {
  const ::Ipopt::SmartPtr<Problem> problem = new Problem(qp);
  const auto status = application_->ipopt->OptimizeTNLP(::Ipopt::GetRawPtr(problem));
  if (status != ::Ipopt::Solve_Succeeded) return std::nullopt;
  return problem->solution();
}

}  // namespace palpate::fem::qp
