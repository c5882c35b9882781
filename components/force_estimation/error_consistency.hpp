// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

namespace palpate::force_estimation {

/// Normalised estimation error squared (NEES) of one force or place: e' C^-1 e of its error e and
/// covariance C, in the directions in which C has a variance. Chi-squared with `degrees` where C is
/// true.
struct NormalisedError {
  double squared = 0.0;
  int degrees = 0;  ///< rank of C, at most 3; 0: the covariance is not known

  /// Whether the truth is within the 95 % ellipsoid.
  bool IsWithin95() const;
};

/// `error`: estimated minus true value, N or m; `covariance` in the square of its unit. One that is
/// not finite has no degrees.
NormalisedError Normalise(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance);

/// Whether covariances are true, over many forces. The errors of one contact in neighbouring frames
/// are nearly one error (bias, model, location), so that each contact counts as one sample: the
/// mean of its frames.
class ErrorConsistency {
 public:
  /// `contact`: which true contact it belongs to. An error without degrees does not count.
  void Add(const std::string& contact, const NormalisedError& error);

  int contacts() const { return static_cast<int>(of_contact_.size()); }
  int forces() const { return forces_; }  ///< one for each contact and frame
  /// NEES over its degrees of freedom, mean over the contacts: 1 where the covariances are true,
  /// above where they are too small. NaN without any force.
  double NeesPerDegree() const;
  /// Ends of the range that NeesPerDegree of true covariances has with 95 %, where the frames of a
  /// contact have one error; it is narrower where they have several. NaN without any force.
  double LowestExpected() const { return Expected(0.025); }
  double HighestExpected() const { return Expected(0.975); }
  /// Share of forces within their 95 % ellipsoids, mean over the contacts.
  double ShareWithin95() const;

 private:
  struct Sum {
    double per_degree = 0.0;
    int within = 0;
    int degrees = 0;
    int forces = 0;
  };
  double Expected(double probability) const;

  std::map<std::string, Sum> of_contact_;
  int forces_ = 0;
};

}  // namespace palpate::force_estimation
