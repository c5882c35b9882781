// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/error_consistency.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

struct ConsistencyTuning {
  /// Variances below this share of the largest are of directions that were given, and rounding.
  double least_variance = 1e-9;
};
constexpr ConsistencyTuning kConsistencyTuning;

constexpr double kNoForce = std::numeric_limits<double>::quiet_NaN();

}  // namespace

bool NormalisedError::IsWithin95() const {
  return degrees > 0 && squared <= ChiSquaredQuantile(0.95, degrees);
}

NormalisedError Normalise(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  NormalisedError normalised;
  if (!covariance.allFinite() || !error.allFinite()) return normalised;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const double least = kConsistencyTuning.least_variance * eigen.eigenvalues()[2];
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double variance = eigen.eigenvalues()[k];
    if (!(variance > least)) continue;
    const double along = eigen.eigenvectors().col(k).dot(error);
    normalised.squared += along * along / variance;
    ++normalised.degrees;
  }
  return normalised;
}

void ErrorConsistency::Add(const std::string& contact, const NormalisedError& error) {
  if (error.degrees == 0) return;
  Sum& sum = of_contact_[contact];
  sum.per_degree += error.squared / error.degrees;
  sum.within += error.IsWithin95() ? 1 : 0;
  sum.degrees += error.degrees;
  ++sum.forces;
  ++forces_;
}

double ErrorConsistency::NeesPerDegree() const {
  double mean = 0.0;
  for (const auto& [contact, sum] : of_contact_) mean += sum.per_degree / sum.forces;
  return forces_ > 0 ? mean / contacts() : kNoForce;
}

double ErrorConsistency::ShareWithin95() const {
  double mean = 0.0;
  for (const auto& [contact, sum] : of_contact_) {
    mean += static_cast<double>(sum.within) / sum.forces;
  }
  return forces_ > 0 ? mean / contacts() : kNoForce;
}

double ErrorConsistency::Expected(double probability) const {
  double degrees = 0.0;
  for (const auto& [contact, sum] : of_contact_) {
    degrees += static_cast<double>(sum.degrees) / sum.forces;
  }
  const auto whole = static_cast<int>(std::lround(degrees));
  return forces_ > 0 ? ChiSquaredQuantile(probability, whole) / whole : kNoForce;
}

}  // namespace palpate::force_estimation
