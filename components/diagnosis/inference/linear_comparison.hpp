// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/diagnosis/inference/hypothesis_set.hpp"

namespace palpate::diagnosis {

/// Bayes factors of single faults by one linear model, of any number of data sets with the same
/// Jacobian: the parameters of the null model are integrated out once.
class LinearComparison {
 public:
  /// Against the hypothesis with the prior `base`. `hypotheses` must outlive it. `H` [parameters x
  /// parameters] as of Information.
  LinearComparison(const HypothesisSet& hypotheses, const Eigen::MatrixXd& H, GaussianPrior base);

  /// ln BF of each fault against it, of data with this b [parameters] as of Information, with the
  /// discrepancies' deviations as the base has them; -infinity for nuisance models.
  Eigen::VectorXd LnBayesFactors(const Eigen::VectorXd& b) const;
  /// Of one fault, and its posterior mean.
  double LnBayesFactor(int fault, const Eigen::VectorXd& b, Eigen::VectorXd* mean) const;

 private:
  /// What data say of a fault's own parameters, its own tolerances left out.
  struct Own {
    Eigen::MatrixXd H;     ///< [own x own]
    Eigen::MatrixXd of_b;  ///< [own x parameters] b about these is that times b
  };
  Own OwnOf(int fault) const;

  const HypothesisSet& hypotheses_;
  GaussianPrior base_;
  std::vector<Eigen::Index> free_;
  Eigen::MatrixXd H_;          ///< beside the null model's parameters
  Eigen::MatrixXd from_b_;     ///< [parameters x free] what these take off b
  Eigen::VectorXd b_of_mean_;  ///< [parameters] b that the base's prior mean makes
  std::vector<Own> of_fault_;
};

/// The smallest size of each fault that would be named: expected ln BF `clear_evidence`, and
/// `least_tolerances` of its tolerances. |z| of one of its parameters; infinite: there is none that
/// is plausible. [faults of the hypothesis set]
struct SmallestSize {
  int fault = -1;
  int parameter = 0;
  double z = 0.0;
};
std::vector<SmallestSize> FindSmallestSizes(const HypothesisSet& hypotheses,
                                            const LinearComparison& comparison,
                                            const Eigen::MatrixXd& H, double clear_evidence,
                                            double least_tolerances);

}  // namespace palpate::diagnosis
