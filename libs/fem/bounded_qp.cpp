// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/bounded_qp.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::fem {

namespace {

enum class Side : signed char { kFree, kLower, kUpper };
using Sides = std::array<Side, kMaxQpVariables>;

/// The problem in variables y = x / scale with a unit diagonal.
struct ScaledQp {
  BoundedQp qp;
  QpVector scale;
  double gradient_scale = 1.0;
};

ScaledQp Scale(const BoundedQp& qp) {
  ScaledQp scaled{qp, QpVector::Ones(qp.c.size()), 1.0};
  for (Eigen::Index i = 0; i < qp.c.size(); ++i) {
    if (qp.H(i, i) > 0.0) scaled.scale[i] = 1.0 / std::sqrt(qp.H(i, i));
  }
  scaled.qp.H = scaled.scale.asDiagonal() * qp.H * scaled.scale.asDiagonal();
  scaled.qp.c = scaled.scale.cwiseProduct(qp.c);
  scaled.qp.lower = qp.lower.cwiseQuotient(scaled.scale);
  scaled.qp.upper = qp.upper.cwiseQuotient(scaled.scale);
  const double largest = qp.c.size() > 0 ? scaled.qp.c.cwiseAbs().maxCoeff() : 0.0;
  if (largest > 0.0) scaled.gradient_scale = largest;
  return scaled;
}

enum class StepKind {
  kToMinimum,  ///< over the free variables, the others staying
  kRay,        ///< H has no curvature along the step: the objective falls up to the next bound
};

StepKind FreeStep(const BoundedQp& qp, const Sides& sides, const QpVector& gradient,
                  double tolerance, QpVector* step) {
  std::array<Eigen::Index, kMaxQpVariables> index{};
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    if (sides[static_cast<size_t>(i)] == Side::kFree) index[static_cast<size_t>(count++)] = i;
  }
  *step = QpVector::Zero(gradient.size());
  if (count == 0) return StepKind::kToMinimum;
  QpMatrix H(count, count);
  QpVector g(count);
  for (Eigen::Index a = 0; a < count; ++a) {
    g[a] = gradient[index[static_cast<size_t>(a)]];
    for (Eigen::Index b = 0; b < count; ++b) {
      H(a, b) = qp.H(index[static_cast<size_t>(a)], index[static_cast<size_t>(b)]);
    }
  }
  const Eigen::SelfAdjointEigenSolver<QpMatrix> eigen(H);
  const QpVector projected = eigen.eigenvectors().transpose() * g;
  QpVector to_minimum = QpVector::Zero(count);
  QpVector ray = QpVector::Zero(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    if (eigen.eigenvalues()[k] > 1e-13 * static_cast<double>(count)) {
      to_minimum -= projected[k] / eigen.eigenvalues()[k] * eigen.eigenvectors().col(k);
    } else if (std::abs(projected[k]) > tolerance) {
      ray -= projected[k] * eigen.eigenvectors().col(k);
    }
  }
  const bool falls_without_end = (ray.array() != 0.0).any();
  // What is left of rounding must not meet a bound far away.
  const double rounding = 1e-10 * ray.cwiseAbs().maxCoeff();
  ray = (ray.array().abs() > rounding).select(ray, 0.0);
  const QpVector& p = falls_without_end ? ray : to_minimum;
  for (Eigen::Index a = 0; a < count; ++a) (*step)[index[static_cast<size_t>(a)]] = p[a];
  return falls_without_end ? StepKind::kRay : StepKind::kToMinimum;
}

/// Largest multiple of `step`, up to `longest`, that stays within the bounds; `blocking` gets the
/// bound that stops it, or -1.
double StepToBounds(const BoundedQp& qp, const QpVector& y, const QpVector& step, double longest,
                    Eigen::Index* blocking) {
  double length = longest;
  *blocking = -1;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    if (step[i] == 0.0) continue;
    const double room = (step[i] < 0.0 ? qp.lower[i] : qp.upper[i]) - y[i];
    if (room / step[i] < length) {
      length = std::max(0.0, room / step[i]);
      *blocking = i;
    }
  }
  return length;
}

/// The active bound whose multiplier has the wrong sign the most, or -1. After many iterations the
/// first one (Bland's rule), so that degenerate problems cannot cycle.
Eigen::Index BoundToRelease(const Sides& sides, const QpVector& gradient, double tolerance,
                            bool first) {
  Eigen::Index worst = -1;
  double worst_pull = tolerance;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    const Side side = sides[static_cast<size_t>(i)];
    if (side == Side::kFree) continue;
    const double pull = side == Side::kLower ? -gradient[i] : gradient[i];
    if (pull > worst_pull) {
      worst = i;
      worst_pull = pull;
      if (first) break;
    }
  }
  return worst;
}

Sides SidesOf(const BoundedQp& qp, const QpVector& y) {
  Sides sides{};
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    Side& side = sides[static_cast<size_t>(i)];
    if (y[i] == qp.lower[i])
      side = Side::kLower;
    else if (y[i] == qp.upper[i])
      side = Side::kUpper;
  }
  return sides;
}

/// x = scale y; exactly on its bound where that is active, and nowhere outside.
QpVector Unscale(const BoundedQp& qp, const QpVector& scale, const QpVector& y,
                 const Sides& sides) {
  QpVector x = y.cwiseProduct(scale).cwiseMax(qp.lower).cwiseMin(qp.upper);
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const Side side = sides[static_cast<size_t>(i)];
    if (side == Side::kLower) x[i] = qp.lower[i];
    if (side == Side::kUpper) x[i] = qp.upper[i];
  }
  return x;
}

double KktResidual(const BoundedQp& qp, const QpVector& y, const QpVector& gradient) {
  double residual = 0.0;
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double moved = std::min(std::max(y[i] - gradient[i], qp.lower[i]), qp.upper[i]);
    residual = std::max(residual, std::abs(moved - y[i]));
  }
  return residual;
}

}  // namespace

BoundedQpResult SolveBoundedQp(const BoundedQp& qp, const QpVector& start) {
  const Eigen::Index n = qp.c.size();
  PALPATE_CHECK(n <= kMaxQpVariables && qp.H.rows() == n && start.size() == n, n, start.size());
  BoundedQpResult result;
  result.x = start;
  if (!qp.H.allFinite() || !qp.c.allFinite() || !start.allFinite() ||
      !(qp.lower.array() <= qp.upper.array()).all()) {
    result.status = Status(StatusCode::kInvalidInput, {});
    return result;
  }
  const ScaledQp scaled = Scale(qp);
  const BoundedQp& problem = scaled.qp;
  QpVector y = start.cwiseQuotient(scaled.scale).cwiseMax(problem.lower).cwiseMin(problem.upper);
  Sides sides = SidesOf(problem, y);
  const int max_iterations = 50 * static_cast<int>(n) + 50;
  for (result.iterations = 1; result.iterations <= max_iterations; ++result.iterations) {
    const QpVector gradient = problem.H * y + problem.c;
    QpVector step;
    const StepKind kind = FreeStep(problem, sides, gradient, 1e-9 * scaled.gradient_scale, &step);
    const double longest = kind == StepKind::kRay ? std::numeric_limits<double>::infinity() : 1.0;
    Eigen::Index blocking = -1;
    const double length = StepToBounds(problem, y, step, longest, &blocking);
    if (kind == StepKind::kRay && blocking < 0) {
      result.status = Status(StatusCode::kUnobservable, {});
      return result;
    }
    y += length * step;
    if (blocking >= 0) {
      const bool lower = step[blocking] < 0.0;
      y[blocking] = lower ? problem.lower[blocking] : problem.upper[blocking];
      sides[static_cast<size_t>(blocking)] = lower ? Side::kLower : Side::kUpper;
      continue;
    }
    const QpVector reached = problem.H * y + problem.c;
    // Entries of H are at most 1 now: y tells how large the terms are that rounding acts on.
    const double tolerance =
        1e-12 * std::max(scaled.gradient_scale, n > 0 ? y.cwiseAbs().maxCoeff() : 0.0);
    const Eigen::Index release =
        BoundToRelease(sides, reached, tolerance, result.iterations > 10 * static_cast<int>(n));
    if (release < 0) {
      result.x = Unscale(qp, scaled.scale, y, sides);
      result.kkt_residual = KktResidual(problem, y, reached) / scaled.gradient_scale;
      result.status = Status::Ok();
      return result;
    }
    sides[static_cast<size_t>(release)] = Side::kFree;
  }
  result.status = Status(StatusCode::kNotConverged, {});
  return result;
}

}  // namespace palpate::fem
