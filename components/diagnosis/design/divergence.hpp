// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/inference/evidence.hpp"

namespace palpate::diagnosis {

/// ln p_a(y) - ln p_b(y) of new data y that is expected if a is right: the Kullback-Leibler
/// divergence of their predictions. y = J z + noise of unit variance, z ~ N(mean, covariance) as
/// data so far leave each model. Never below 0; more rows never lessen it.
double ExpectedLnBayesFactor(const Eigen::MatrixXd& J, const Posterior& a, const Posterior& b);

/// By how much new data sharpen what is known of some parameters: ln of the ratio of the volumes
/// that their posterior takes before and after. Those that are held count for nothing.
double InformationGain(const Eigen::MatrixXd& J, const Posterior& posterior,
                       const std::vector<Eigen::Index>& parameters);

}  // namespace palpate::diagnosis
