// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/bounded_qp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/bounded_qp_step.hpp"

namespace palpate::fem {

namespace {

using Eigen::Index;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// Multipliers of active bounds up to this, in units of the terms that they are the sum of, may be
/// rounding. (kFlatSlope is for slopes that depend on the caller's rounding, too.)
constexpr double kRounding = 1e-12;
/// 1e-16 of the terms before a step is the rounding after it; kRounding / kMemory leaves it room.
constexpr double kMemory = 256.0;
/// Steps from far away are repeated so often, to get rid of their rounding.
constexpr int kMaxRefinements = 3;

enum class Side : signed char {
  kFree,
  kLower,
  kUpper,
  kFixed,  ///< for good: the bounds are equal, or nothing in H acts on the variable
};

template <typename Type>
using PerVariable = std::array<Type, kMaxQpVariables>;

Side& SideOf(PerVariable<Side>& sides, Index i) { return sides[At(i)]; }
Side SideOf(const PerVariable<Side>& sides, Index i) { return sides[At(i)]; }

/// The problem in variables y = x / scale that bring H's diagonal to 1/2..2. Scales are powers of
/// two, so that scaling rounds nothing.
struct ScaledQp {
  BoundedQp qp;
  QpVector scale;
};

/// Where the iteration stands.
struct Iterate {
  QpVector y;
  PerVariable<Side> sides{};
  QpVector gradient;
  /// |c_i| + sum_j |H_ij y_j|: the size of what rounding acts on in each entry of the gradient.
  QpVector terms;
  /// The same, but at least 1/kMemory of what it was before the last step: y keeps its rounding.
  QpVector magnitude;
  /// Multipliers up to this turned out to be rounding.
  QpVector refuted;
};

double PowerOfTwoScale(double diagonal) {
  if (!(diagonal > 0.0)) return 1.0;
  const int exponent = std::ilogb(diagonal);
  return std::ldexp(1.0, -(exponent + (exponent & 1)) / 2);
}

ScaledQp Scale(const BoundedQp& qp) {
  const Index n = qp.c.size();
  ScaledQp scaled{{QpMatrix(n, n), QpVector(n), QpVector(n), QpVector(n)}, QpVector(n)};
  for (Index i = 0; i < n; ++i) {
    const double scale = PowerOfTwoScale(qp.H(i, i));
    scaled.scale[i] = scale;
    scaled.qp.c[i] = scale * qp.c[i];
    scaled.qp.lower[i] = qp.lower[i] / scale;
    scaled.qp.upper[i] = qp.upper[i] / scale;
    for (Index j = 0; j <= i; ++j) {
      const double mean = 0.5 * (scale * qp.H(i, j) + scale * qp.H(j, i)) * scaled.scale[j];
      scaled.qp.H(i, j) = scaled.qp.H(j, i) = mean;
    }
  }
  return scaled;
}

void Evaluate(const BoundedQp& qp, Iterate* at) {
  at->gradient = qp.c;
  at->terms = qp.c.cwiseAbs();
  for (Index j = 0; j < qp.c.size(); ++j) {
    if (at->y[j] == 0.0) continue;
    at->gradient += at->y[j] * qp.H.col(j);
    at->terms += std::abs(at->y[j]) * qp.H.col(j).cwiseAbs();
  }
  at->magnitude = at->terms.cwiseMax(at->magnitude / kMemory);
}

FreeBlock GatherFree(const BoundedQp& qp, const Iterate& at, Index released) {
  FreeBlock block;
  Index count = 0;
  for (Index i = 0; i < at.y.size(); ++i) {
    if (SideOf(at.sides, i) == Side::kFree) block.variable[At(count++)] = i;
  }
  block.H.resize(count, count);
  block.gradient.resize(count);
  block.magnitude.resize(count);
  block.descent.resize(count);
  for (Index a = 0; a < count; ++a) {
    const Index i = block.variable[At(a)];
    block.gradient[a] = at.gradient[i];
    block.magnitude[a] = at.magnitude[i];
    block.descent[a] = released < 0 || i == released ? at.gradient[i] : 0.0;
    for (Index b = 0; b < count; ++b) {
      block.H(b, a) = qp.H(block.variable[At(b)], i);
    }
  }
  return block;
}

StepKind FreeStep(const BoundedQp& qp, const Iterate& at, Index released, QpVector* step) {
  const FreeBlock block = GatherFree(qp, at, released);
  QpVector free_step(block.gradient.size());
  const StepKind kind = StepOf(block, &free_step);
  step->setZero(at.y.size());
  for (Index a = 0; a < free_step.size(); ++a) {
    (*step)[block.variable[At(a)]] = free_step[a];
  }
  return kind;
}

/// Largest multiple of `step`, up to `longest`, that stays within the bounds; `blocking` gets the
/// bound that stops it, or -1.
double StepToBounds(const BoundedQp& qp, const QpVector& y, const QpVector& step, double longest,
                    Index* blocking) {
  double length = longest;
  *blocking = -1;
  for (Index i = 0; i < y.size(); ++i) {
    if (step[i] == 0.0) continue;
    const double room = (step[i] < 0.0 ? qp.lower[i] : qp.upper[i]) - y[i];
    if (room / step[i] < length) {
      length = std::max(0.0, room / step[i]);
      *blocking = i;
    }
  }
  return length;
}

/// How far down a ray the objective falls: what curvature H has there, be it rounding, ends it, so
/// that every step lowers the objective and no set of active bounds comes back.
double EndOfRay(const BoundedQp& qp, const Iterate& at, const QpVector& ray) {
  const double curvature = ray.dot(qp.H * ray);
  return curvature > 0.0 ? -at.gradient.dot(ray) / curvature : kUnbounded;
}

/// How much the objective falls for each unit that the variable leaves its bound by.
double Pull(const Iterate& at, Index i) {
  return SideOf(at.sides, i) == Side::kLower ? -at.gradient[i] : at.gradient[i];
}

/// The active bound whose multiplier has the wrong sign the most, or -1.
Index BoundToRelease(const Iterate& at, double rounding) {
  Index worst = -1;
  double worst_pull = 0.0;
  for (Index i = 0; i < at.y.size(); ++i) {
    const Side side = SideOf(at.sides, i);
    if (side == Side::kFree || side == Side::kFixed) continue;
    const double pull = Pull(at, i);
    if (pull > std::max({worst_pull, rounding * at.magnitude[i], at.refuted[i]})) {
      worst = i;
      worst_pull = pull;
    }
  }
  return worst;
}

/// Sides of the start. A variable on which nothing in H acts goes where c sends it, at once; false
/// where there is no bound.
bool SetSides(const BoundedQp& qp, Iterate* at) {
  for (Index i = 0; i < at->y.size(); ++i) {
    Side& side = SideOf(at->sides, i);
    if ((qp.H.col(i).array() == 0.0).all()) {
      side = Side::kFixed;
      if (qp.c[i] != 0.0) at->y[i] = qp.c[i] > 0.0 ? qp.lower[i] : qp.upper[i];
      if (!std::isfinite(at->y[i])) return false;
    } else if (qp.lower[i] == qp.upper[i]) {
      side = Side::kFixed;
    } else if (at->y[i] == qp.lower[i]) {
      side = Side::kLower;
    } else if (at->y[i] == qp.upper[i]) {
      side = Side::kUpper;
    }
  }
  return true;
}

void Move(const BoundedQp& qp, const QpVector& step, double length, Index blocking, Iterate* at) {
  at->y = (at->y + length * step).cwiseMax(qp.lower).cwiseMin(qp.upper);
  if (blocking >= 0) {
    const bool lower = step[blocking] < 0.0;
    at->y[blocking] = lower ? qp.lower[blocking] : qp.upper[blocking];
    SideOf(at->sides, blocking) = lower ? Side::kLower : Side::kUpper;
  }
  Evaluate(qp, at);
}

/// Whether rounding of the last step is still to be seen in the gradient of free variables.
bool IsRough(const Iterate& at) {
  for (Index i = 0; i < at.y.size(); ++i) {
    if (SideOf(at.sides, i) == Side::kFree && std::abs(at.gradient[i]) > kRounding * at.terms[i]) {
      return true;
    }
  }
  return false;
}

/// From the present iterate to the solution.
StatusCode Minimise(const BoundedQp& qp, Iterate* at, int* iterations) {
  const int n = static_cast<int>(qp.c.size());
  Evaluate(qp, at);
  Index released = -1;
  Side left = Side::kFree;
  int refinements = 0;
  for (*iterations = 1; *iterations <= 50 * n + 50; ++*iterations) {
    QpVector step;
    const StepKind kind = FreeStep(qp, *at, released, &step);
    if (kind == StepKind::kFailed || !step.allFinite()) return StatusCode::kNotConverged;
    if (released >= 0 && !(left == Side::kLower ? step[released] > 0.0 : step[released] < 0.0)) {
      // A multiplier of the wrong sign means a step away from the bound: this one was rounding.
      SideOf(at->sides, released) = left;
      at->refuted[released] = 2.0 * std::abs(at->gradient[released]);
      released = -1;
      continue;
    }
    released = -1;
    Index blocking = -1;
    const bool ray = kind == StepKind::kRay;
    double length = StepToBounds(qp, at->y, step, ray ? kUnbounded : 1.0, &blocking);
    if (ray && blocking < 0) return StatusCode::kUnobservable;
    if (const double end = ray ? EndOfRay(qp, *at, step) : kUnbounded; end < length) {
      length = end;
      blocking = -1;
    }
    Move(qp, step, length, blocking, at);
    if (ray || blocking >= 0) continue;
    if (refinements < kMaxRefinements && IsRough(*at)) {
      ++refinements;
      continue;
    }
    // So many iterations are never needed: rounding makes them, so more is put down to it.
    released = BoundToRelease(*at, *iterations <= 10 * n ? kRounding : kFlatSlope);
    if (released < 0) return StatusCode::kOk;
    left = std::exchange(SideOf(at->sides, released), Side::kFree);
  }
  return StatusCode::kNotConverged;
}

/// x = scale y; exactly on its bound where that is active, and nowhere outside.
QpVector Unscale(const BoundedQp& qp, const ScaledQp& scaled, const Iterate& at) {
  QpVector x = at.y.cwiseProduct(scaled.scale).cwiseMax(qp.lower).cwiseMin(qp.upper);
  for (Index i = 0; i < x.size(); ++i) {
    if (at.y[i] == scaled.qp.lower[i]) x[i] = qp.lower[i];
    if (at.y[i] == scaled.qp.upper[i]) x[i] = qp.upper[i];
  }
  return x;
}

double KktResidual(const BoundedQp& qp, const Iterate& at) {
  double residual = 0.0;
  double unit = 0.0;
  for (Index i = 0; i < at.y.size(); ++i) {
    const double moved = std::min(std::max(at.y[i] - at.gradient[i], qp.lower[i]), qp.upper[i]);
    residual = std::max(residual, std::abs(moved - at.y[i]));
    unit = std::max(unit, at.magnitude[i]);
  }
  return residual > 0.0 ? residual / unit : 0.0;
}

bool IsValid(const BoundedQp& qp, const QpVector& start) {
  return qp.H.allFinite() && qp.c.allFinite() && start.allFinite() &&
         (qp.lower.array() <= qp.upper.array()).all() && (qp.lower.array() < kUnbounded).all() &&
         (qp.upper.array() > -kUnbounded).all();
}

}  // namespace

BoundedQpResult SolveBoundedQp(const BoundedQp& qp, const QpVector& start) {
  const Index n = qp.c.size();
  PALPATE_CHECK(n <= kMaxQpVariables && qp.H.rows() == n && qp.H.cols() == n, n);
  PALPATE_CHECK(qp.lower.size() == n && qp.upper.size() == n && start.size() == n, n);
  BoundedQpResult result;
  result.x = start;
  result.status = Status(StatusCode::kInvalidInput, {});
  if (!IsValid(qp, start)) return result;
  const ScaledQp scaled = Scale(qp);
  Iterate at;
  at.y = start.cwiseQuotient(scaled.scale).cwiseMax(scaled.qp.lower).cwiseMin(scaled.qp.upper);
  at.magnitude = at.refuted = QpVector::Zero(n);
  if (!scaled.qp.H.allFinite() || !scaled.qp.c.allFinite() || !at.y.allFinite()) return result;
  StatusCode code = StatusCode::kUnobservable;
  if (SetSides(scaled.qp, &at)) code = Minimise(scaled.qp, &at, &result.iterations);
  if (code == StatusCode::kOk) {
    result.x = Unscale(qp, scaled, at);
    result.kkt_residual = KktResidual(scaled.qp, at);
  }
  result.status = Status(code, {});
  return result;
}

}  // namespace palpate::fem
