// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "libs/fem/sparse/front_schedule.hpp"
#include "libs/fem/sparse/front_tree.hpp"

namespace palpate::fem::internal {

/// Where forward substitution writes. A thread's own subtrees subtract from rows of fronts that all
/// work on together: each thread has a share of such rows to itself, behind the rows of the matrix,
/// thread after thread, and the shares are added up when all are done.
struct SubstitutionPlan {
  std::vector<std::vector<int>> forward_rows;  ///< [fronts] rows below the pivots, or their shares
  std::vector<int> shared_rows;                ///< rows of the matrix that have shares
  int most_pivots = 0;                         ///< of any front
};

/// `size`: rows of the matrix.
SubstitutionPlan PlanSubstitution(const FrontTree& tree, const FrontSchedule& schedule, int size);

}  // namespace palpate::fem::internal
