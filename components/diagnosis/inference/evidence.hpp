// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/diagnosis/inference/linear_model.hpp"

namespace palpate::diagnosis {

/// A Gaussian prior about each parameter before the data: sigma 0 holds it at its mean.
struct GaussianPrior {
  Eigen::VectorXd mean;
  Eigen::VectorXd sigma;

  explicit GaussianPrior(Eigen::Index parameters)
      : mean(Eigen::VectorXd::Zero(parameters)), sigma(Eigen::VectorXd::Zero(parameters)) {}
};

/// What prior and data say together.
struct Posterior {
  double ln_evidence = 0.0;  ///< ln p(data) up to a constant of the data
  double misfit = 0.0;       ///< chi-squared of data and prior at the mean
  Eigen::VectorXd mean;      ///< [parameters] the most probable
  Eigen::MatrixXd covariance;
};

/// Normal priors, linear data: exact. With D = diag(sigma), A = I + D H D,
///   ln p = -(c - g' A^-1 g + ln det A) / 2, g = D (b - H mean), all about the mean.
Posterior Infer(const Information& data, const GaussianPrior& prior);

}  // namespace palpate::diagnosis
