// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/inference/evidence.hpp"

namespace palpate::diagnosis {

/// Prior of a group's deviation: uniform in its logarithm between these. A body that differs from
/// its simulation by more than `most` of what it does is no nominal one.
struct GroupScaleTuning {
  double least = 1e-3;
  double most = 0.03;
  double start = 0.01;
  double first_step = 0.7;  ///< of ln scale
  double last_step = 0.1;
  int most_rounds = 3;  ///< over all groups
};

/// The most probable deviation of each group (empirical Bayes: MacKay 1992), all parameters
/// integrated out. `prior` has the deviations in units of them; `group_of` [parameters], -1: none.
/// `start` [groups] may be empty.
Eigen::VectorXd InferGroupScale(const Information& data, const GaussianPrior& prior,
                                const std::vector<int>& group_of, int groups,
                                const Eigen::VectorXd& start = {},
                                const GroupScaleTuning& tuning = {});

}  // namespace palpate::diagnosis
