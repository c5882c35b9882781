// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate::perception {

/// Gives each row of `cost` (finite, no more rows than columns) a column of its own so that the sum
/// of the costs is least: the Hungarian method, O(rows^2 columns). Of equal sums always the same.
std::vector<int> AssignRows(const Eigen::MatrixXd& cost);

}  // namespace palpate::perception
