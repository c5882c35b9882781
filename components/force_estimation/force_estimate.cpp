// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/force_estimate.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

struct ForceIntervalTuning {
  /// The interval is linear while what |F| has of second order is below this share of its variance:
  /// then its half-width is good to a thousandth.
  double second_order = 1e-3;
  int bisections = 10;  ///< more: finer ends, down to what the sample resolves
};
constexpr ForceIntervalTuning kForceIntervalTuning;

constexpr int kDraws = 2048;
using Draws = Eigen::Matrix<double, 3, kDraws>;

/// A standard normal vector in three dimensions, evenly: the additive recurrence of Roberts'
/// sequence R3, mapped by the normal quantile.
const Draws& NormalDraws() {
  static const Draws draws = [] {
    constexpr double kRoot = 1.2207440846057596;  // of g^4 = g + 1
    Draws made;
    for (int k = 0; k < kDraws; ++k) {
      for (int i = 0; i < 3; ++i) {
        const double at = 0.5 + (k + 1) * std::pow(kRoot, -(i + 1));
        made(i, k) = NormalQuantile(at - std::floor(at));
      }
    }
    return made;
  }();
  return draws;
}

/// What |force + e| is below with a probability of `share`, e of the covariance root root'.
double SizeQuantile_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& root_N, double share) {
  std::array<double, kDraws> size_N;
  for (int k = 0; k < kDraws; ++k) {
    size_N[static_cast<size_t>(k)] = (force_N + root_N * NormalDraws().col(k)).norm();
  }
  const auto quantile = size_N.begin() + static_cast<std::ptrdiff_t>(share * kDraws);
  std::nth_element(size_N.begin(), quantile, size_N.end());
  return *quantile;
}

/// A true size along `along` of which `share` of the estimates are above `size_N`, between the ends
/// of the last bisection, from 0 to `most_N`.
std::pair<double, double> TrueSize_N(double size_N, const Eigen::Vector3d& along,
                                     const Eigen::Matrix3d& root_N, double share, double most_N) {
  double below_N = 0.0;
  double above_N = most_N;
  for (int step = 0; step < kForceIntervalTuning.bisections; ++step) {
    const double middle_N = 0.5 * (below_N + above_N);
    const bool less = SizeQuantile_N(middle_N * along, root_N, 1.0 - share) < size_N;
    (less ? below_N : above_N) = middle_N;
  }
  return {below_N, above_N};
}

/// Whether some force along this axis of the covariance is within the 95 % ellipsoid about the
/// estimate, whose components along the axes are `in_axes_N`.
bool IsPossible(Eigen::Index axis, const Eigen::Vector3d& in_axes_N,
                const Eigen::Vector3d& variances_N2) {
  double squared = 0.0;
  for (Eigen::Index other = 0; other < 3; ++other) {
    if (other == axis || in_axes_N[other] == 0.0) continue;
    squared += in_axes_N[other] * in_axes_N[other] / std::max(0.0, variances_N2[other]);
  }
  return squared <= ChiSquaredQuantile(0.95, 3);
}

/// Neyman's interval: true sizes of which the estimate is not among the 2.5 % at either end. The
/// true force may have the direction of the estimate, or be along an axis of the covariance.
double SampledHalfWidth_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_N2);
  const Eigen::Matrix3d root_N =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const double size_N = force_N.norm();
  const double most_N = size_N + 3.0 * root_N.norm();
  const auto half_width_N = [&](const Eigen::Vector3d& along) {
    const double low_N = TrueSize_N(size_N, along, root_N, 0.025, most_N).first;
    const double high_N = TrueSize_N(size_N, along, root_N, 0.975, most_N).second;
    return std::max(size_N - low_N, high_N - size_N);
  };
  double half_N = size_N > 0.0 ? half_width_N(force_N / size_N) : 0.0;
  const Eigen::Vector3d in_axes_N = eigen.eigenvectors().transpose() * force_N;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!IsPossible(axis, in_axes_N, eigen.eigenvalues())) continue;
    half_N = std::max(half_N, half_width_N(eigen.eigenvectors().col(axis)));
  }
  return half_N;
}

}  // namespace

bool IsUsable(const Status& status) {
  return status.ok() || status.code() == StatusCode::kNoContact;
}

double HalfWidthAlong95_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2) {
  const Eigen::Vector3d along = force_N.normalized();
  return kSigmas95 * std::sqrt(std::max(0.0, along.dot(covariance_N2 * along)));
}

double HalfWidth95_N(const Eigen::Vector3d& force_N, const Eigen::Matrix3d& covariance_N2) {
  const double size_N = force_N.norm();
  if (size_N > 0.0) {
    const Eigen::Vector3d along = force_N / size_N;
    const double variance_N2 = std::max(0.0, along.dot(covariance_N2 * along));
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along * along.transpose();
    const Eigen::Matrix3d across_N2 = across * covariance_N2 * across;
    // |F + e| = |F| + e along F + (e across F)^2 / 2|F|: bias and variance of the last term.
    const double bias_N = 0.5 * across_N2.trace() / size_N;
    const double second_N2 = bias_N * bias_N + 0.5 * across_N2.squaredNorm() / (size_N * size_N);
    if (second_N2 <= kForceIntervalTuning.second_order * variance_N2) {
      return kSigmas95 * std::sqrt(variance_N2);
    }
  }
  return SampledHalfWidth_N(force_N, covariance_N2);
}

void SetInterval(double uncertain_share, ContactForce* contact) {
  const double wide_N = uncertain_share * contact->force_N.norm();
  if (contact->status.code() == StatusCode::kTangentialUnobservable) {
    contact->ci95_N = HalfWidthAlong95_N(contact->force_N, contact->covariance_N2);
    if (contact->ci95_N <= wide_N) return;
  }
  contact->ci95_N = HalfWidth95_N(contact->force_N, contact->covariance_N2);
  const bool acts = contact->status.code() != StatusCode::kNoContact;
  if (acts && contact->ci95_N > wide_N) contact->status = Status(StatusCode::kUncertain, {});
}

}  // namespace palpate::force_estimation
