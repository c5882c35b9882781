// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/fault_size.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "libs/core/text.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kBeyondTolerance = 3.0;

/// By how many sigmas the data exclude a healthy robot, of a cause with sizes that begin at nothing
/// beside such as a healthy robot may have: of these the likeliest where the others are nothing. 0:
/// it has none of them. Data may tell the sum of a delay and a time constant, and neither of them.
double SigmasFromHealthy(const HypothesisSet& hypotheses, const Posterior& posterior, int cause) {
  std::vector<Eigen::Index> tolerated;
  std::vector<double> tolerance;
  std::vector<Eigen::Index> others;
  for (Eigen::Index p = 0; p < hypotheses.count(cause); ++p) {
    const Eigen::Index column = hypotheses.first(cause) + p;
    const FaultParameter& parameter =
        hypotheses.cause(cause).parameters()[static_cast<std::size_t>(p)];
    if (!(posterior.covariance(column, column) > 0.0)) continue;  // it is at its bound
    if (const double own = hypotheses.ToleranceOf(cause, static_cast<int>(p)); own > 0.0) {
      tolerated.push_back(column);
      tolerance.push_back(own);
    } else if (parameter.scale == FaultParameter::Scale::kLinear && parameter.least == 0.0) {
      others.push_back(column);
    }
  }
  if (others.empty()) return 0.0;
  const Eigen::MatrixXd& covariance = posterior.covariance;
  const Eigen::VectorXd gone = posterior.mean(others);
  const Eigen::VectorXd reach =
      kBeyondTolerance * Eigen::VectorXd::Map(tolerance.data(), std::ssize(tolerance));
  const Eigen::MatrixXd covariance_of_others = covariance(others, others);
  const Eigen::MatrixXd both = covariance(tolerated, others);
  const Eigen::VectorXd likeliest =
      posterior.mean(tolerated) - both * linalg::SolveSymmetric(covariance_of_others, gone);
  Eigen::VectorXd off(std::ssize(tolerated) + std::ssize(others));
  off << posterior.mean(tolerated) - likeliest.cwiseMax(-reach).cwiseMin(reach), gone;
  std::vector<Eigen::Index> all = tolerated;
  all.insert(all.end(), others.begin(), others.end());
  const Eigen::MatrixXd covariance_of_all = covariance(all, all);
  return std::sqrt(off.dot(linalg::SolveSymmetric(covariance_of_all, off)));
}

/// How many of its tolerances a cause is away from the robot file; infinite for one that a healthy
/// robot has nothing of, of which the evidence says all.
double SizeInTolerances(const HypothesisSet& hypotheses, const Posterior& posterior, int cause) {
  double most = -1.0;
  double squares = 0.0;
  int components = 0;
  for (Eigen::Index p = 0; p < hypotheses.count(cause); ++p) {
    const double tolerance = hypotheses.ToleranceOf(cause, static_cast<int>(p));
    if (tolerance <= 0.0) continue;
    const double size = std::abs(posterior.mean[hypotheses.first(cause) + p]) / tolerance;
    if (hypotheses.cause(cause).parameters()[static_cast<std::size_t>(p)].component) {
      squares += size * size;
      ++components;
    } else {
      most = std::max(most, size);
    }
  }
  // The tolerance of a vector's length is by that root more than that of each of its components.
  if (components > 0) most = std::max(most, std::sqrt(squares / components));
  const bool beyond = SigmasFromHealthy(hypotheses, posterior, cause) > kBeyondTolerance;
  return most < 0.0 || beyond ? std::numeric_limits<double>::infinity() : most;
}

/// Whether what is known of how large it is does not exclude that there is nothing of it. Evidence
/// for such a one is of fits that did not come to their ends. A wall that nearly touches is one.
bool MayBeNothing(const HypothesisSet& hypotheses, const Posterior& posterior, int cause) {
  constexpr double kClearly_sigmas = 2.0;
  if (hypotheses.cause(cause).Start()) return false;
  std::vector<Eigen::Index> sizes;
  for (Eigen::Index p = 0; p < hypotheses.count(cause); ++p) {
    const Eigen::Index column = hypotheses.first(cause) + p;
    const bool qualifies =
        hypotheses.cause(cause).parameters()[static_cast<std::size_t>(p)].qualifies;
    if (!qualifies && posterior.covariance(column, column) > 0.0) sizes.push_back(column);
  }
  if (sizes.empty()) return false;
  const Eigen::VectorXd z = posterior.mean(sizes);
  const Eigen::MatrixXd covariance = posterior.covariance(sizes, sizes);
  return z.dot(linalg::SolveSymmetric(covariance, z)) <
         kClearly_sigmas * kClearly_sigmas * static_cast<double>(sizes.size());
}

}  // namespace

std::string WhyNoFault(const HypothesisSet& hypotheses, const Posterior& posterior, int cause) {
  if (SizeInTolerances(hypotheses, posterior, cause) < kBeyondTolerance) {
    return "it is within what a healthy robot may have";
  }
  if (MayBeNothing(hypotheses, posterior, cause)) {
    return "what is known of its size does not exclude that there is nothing of it";
  }
  for (Eigen::Index p = 0; p < hypotheses.count(cause); ++p) {
    const FaultParameter& parameter =
        hypotheses.cause(cause).parameters()[static_cast<std::size_t>(p)];
    const double z = posterior.mean[hypotheses.first(cause) + p];
    if (std::abs(z) <= parameter.plausible) continue;
    return "no robot has so much of it (" + parameter.name + " = " +
           FormatNumber(parameter.ValueOf(z)) + "): something else looks like it";
  }
  return {};
}

}  // namespace palpate::diagnosis
