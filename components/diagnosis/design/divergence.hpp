// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/inference/evidence.hpp"
#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {

/// What a model predicts of new data y = J z + noise of unit variance, z ~ N(mean, covariance) as
/// data so far leave it.
struct Prediction {
  Prediction(const Eigen::MatrixXd& J, const Posterior& posterior);

  Eigen::VectorXd mean;        ///< [rows]
  Eigen::MatrixXd covariance;  ///< [rows x rows]
  linalg::Cholesky factor;     ///< of that
};

/// ln p_a(y) - ln p_b(y) of new data y that is expected if a is right: the Kullback-Leibler
/// divergence of their predictions. Never below 0; more rows never lessen it.
double ExpectedLnBayesFactor(const Prediction& a, const Prediction& b);

/// By how much new data, of which `predicted` is what `posterior` says, sharpen what is known of
/// some parameters: ln of the ratio of the volumes that their posterior takes before and after.
/// Those that are held count for nothing.
double InformationGain(const Eigen::MatrixXd& J, const Posterior& posterior,
                       const std::vector<Eigen::Index>& parameters, const Prediction& predicted);

}  // namespace palpate::diagnosis
