// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "components/diagnosis/inference/hypothesis_set.hpp"
#include "components/diagnosis/inference/linear_model.hpp"

namespace palpate::diagnosis {

/// Largest canonical correlation of the effects of the faults a and b in `data`, with the null
/// model's other parameters fitted beside them. [0, 1]; 0 where one has no effect. `scale`: of the
/// discrepancies.
double CanonicalCorrelation(const HypothesisSet& hypotheses, const Information& data,
                            const Eigen::VectorXd& scale, int a, int b);

}  // namespace palpate::diagnosis
