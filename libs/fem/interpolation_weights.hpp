// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::fem {

/// A material point as a fixed combination of nodes: p = sum_k weights[k] * x[nodes[k]].
/// One row of the paper's H_e (the same for x, y and z). The weights add up to 1.
struct InterpolationWeights {
  std::vector<int> nodes;
  std::vector<double> weights;

  /// Position of the point when the nodes are at `x_m` [3n, x y z interleaved].
  Eigen::Vector3d Position(const Eigen::Ref<const Eigen::VectorXd>& x_m) const {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (size_t k = 0; k < nodes.size(); ++k) point += weights[k] * x_m.segment<3>(3 * nodes[k]);
    return point;
  }
};

}  // namespace palpate::fem
