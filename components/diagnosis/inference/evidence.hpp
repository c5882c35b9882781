// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/diagnosis/inference/linear_model.hpp"

namespace palpate::diagnosis {

/// Independent Gaussian prior of each parameter; sigma 0 fixes it at its mean.
struct GaussianPrior {
  Eigen::VectorXd mean;
  Eigen::VectorXd sigma;

  explicit GaussianPrior(Eigen::Index parameters = 0)
      : mean(Eigen::VectorXd::Zero(parameters)), sigma(Eigen::VectorXd::Zero(parameters)) {}
};

/// Posterior of the linear-Gaussian model.
struct Posterior {
  double ln_evidence = 0.0;  ///< ln p(data) up to a constant of the data
  double misfit = 0.0;       ///< chi-squared of data and prior at the mean
  Eigen::VectorXd mean;      ///< [parameters] posterior mean
  Eigen::MatrixXd covariance;
  Eigen::VectorXd scale = {};  ///< [groups] inferred deviation of each DiscrepancyGroup
  GaussianPrior prior{0};      ///< with which it was inferred
};

/// Evidence and posterior, exact for linear data (docs/theory/model_selection.md). With D =
/// diag(sigma), A = I + D H D,
///   ln p = -(c - g' A^-1 g + ln det A) / 2, g = D (b - H mean), all about the mean.
Posterior Infer(const Information& data, const GaussianPrior& prior);

}  // namespace palpate::diagnosis
