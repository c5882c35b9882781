// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/substitution_plan.hpp"

#include <algorithm>

#include "libs/core/index.hpp"

namespace palpate::fem::internal {

SubstitutionPlan PlanSubstitution(const FrontTree& tree, const FrontSchedule& schedule, int size) {
  SubstitutionPlan plan;
  std::vector<int> share(At(size), -1);  // place among shared_rows
  for (const int f : schedule.together) {
    const Front& front = tree.fronts()[At(f)];
    for (int k = 0; k < front.Pivots(); ++k) {
      const int row = 3 * front.first_node + k;
      share[At(row)] = static_cast<int>(plan.shared_rows.size());
      plan.shared_rows.push_back(row);
    }
  }
  for (const Front& front : tree.fronts()) {
    plan.forward_rows.push_back(front.below_rows);
    plan.most_pivots = std::max(plan.most_pivots, front.Pivots());
  }
  const int shares = static_cast<int>(plan.shared_rows.size());
  int first = size;
  for (const std::vector<int>& own : schedule.own) {
    for (const int f : own) {
      for (int& row : plan.forward_rows[At(f)]) {
        if (share[At(row)] >= 0) row = first + share[At(row)];
      }
    }
    first += shares;
  }
  return plan;
}

}  // namespace palpate::fem::internal
