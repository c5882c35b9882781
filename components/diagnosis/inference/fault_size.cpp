// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fault_size.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kBeyondTolerance = 3.0;

/// How many of its tolerances a cause is away from the robot file; infinite for one that a healthy
/// robot has nothing of, of which the evidence says all.
double SizeInTolerances(const CauseBook& book, const Posterior& posterior, int cause) {
  double most = -1.0;
  for (Eigen::Index p = 0; p < book.count(cause); ++p) {
    const double tolerance = book.ToleranceOf(cause, static_cast<int>(p));
    const Eigen::Index column = book.first(cause) + p;
    const double z = posterior.mean[column];
    if (tolerance > 0.0) {
      most = std::max(most, std::abs(z) / tolerance);
      continue;
    }
    // A size that begins at nothing, beside one that a healthy robot may have.
    const CauseParameter& parameter = book.cause(cause).parameters()[static_cast<std::size_t>(p)];
    const bool is_size =
        parameter.scale == CauseParameter::Scale::kLinear && parameter.least == 0.0;
    if (is_size && z > kBeyondTolerance * std::sqrt(posterior.covariance(column, column))) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return most < 0.0 ? std::numeric_limits<double>::infinity() : most;
}

/// Whether what is known of how large it is does not exclude that there is nothing of it. Evidence
/// for such a one is of fits that did not come to their ends. A wall that nearly touches is one.
bool MayBeNothing(const CauseBook& book, const Posterior& posterior, int cause) {
  constexpr double kClearly_sigmas = 2.0;
  if (book.cause(cause).Start()) return false;
  std::vector<Eigen::Index> sizes;
  for (Eigen::Index p = 0; p < book.count(cause); ++p) {
    const Eigen::Index column = book.first(cause) + p;
    const bool qualifies = book.cause(cause).parameters()[static_cast<std::size_t>(p)].qualifies;
    if (!qualifies && posterior.covariance(column, column) > 0.0) sizes.push_back(column);
  }
  if (sizes.empty()) return false;
  const Eigen::VectorXd z = posterior.mean(sizes);
  const Eigen::MatrixXd covariance = posterior.covariance(sizes, sizes);
  return z.dot(covariance.ldlt().solve(z)) <
         kClearly_sigmas * kClearly_sigmas * static_cast<double>(sizes.size());
}

}  // namespace

std::string WhyNoFault(const CauseBook& book, const Posterior& posterior, int cause) {
  if (SizeInTolerances(book, posterior, cause) < kBeyondTolerance) {
    return "it is within what a healthy robot may have";
  }
  if (MayBeNothing(book, posterior, cause)) {
    return "what is known of its size does not exclude that there is nothing of it";
  }
  for (Eigen::Index p = 0; p < book.count(cause); ++p) {
    const CauseParameter& parameter = book.cause(cause).parameters()[static_cast<std::size_t>(p)];
    const double z = posterior.mean[book.first(cause) + p];
    if (std::abs(z) <= parameter.plausible) continue;
    return "no robot has so much of it (" + parameter.name + " = " +
           FormatNumber(parameter.ValueOf(z)) + "): something else looks like it";
  }
  return {};
}

}  // namespace palpate::diagnosis
