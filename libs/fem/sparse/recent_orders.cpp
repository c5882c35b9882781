// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/recent_orders.hpp"

#include <algorithm>

namespace palpate::fem {

EliminationOrder RecentOrders::Find(int node_count, const NodePairs& pairs) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& one) {
    return one.node_count == node_count && one.pairs == pairs;
  });
  if (known != known_.end()) {
    std::rotate(known_.begin(), known, known + 1);
    return known_.front().order;
  }
  ++found_count_;
  known_.push_front({node_count, pairs, FindEliminationOrder(node_count, pairs)});
  if (known_.size() > kKept) known_.pop_back();
  return known_.front().order;
}

}  // namespace palpate::fem
