// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <deque>
#include <mutex>

#include "libs/fem/sparse/elimination_order.hpp"

namespace palpate::fem {

/// The most recent elimination orders. A fit of a robot's parameters makes a
/// solver of the same mesh for each set of them, and to find an order takes as long as some ten
/// factorisations by it. For any number of threads: one that asks for an order that another is
/// looking for waits for it.
class RecentOrders {
 public:
  /// As FindEliminationOrder has it.
  EliminationOrder Find(int node_count, const NodePairs& pairs);

  /// Number of orders that were computed.
  int found_count() const { return found_count_; }

  /// So many are kept: as many as a process has kinds of solvers, and a few of before.
  static constexpr int kKept = 4;

 private:
  struct Known {
    int node_count;
    NodePairs pairs;
    EliminationOrder order;
  };

  std::mutex mutex_;
  std::deque<Known> known_;  ///< the last used first
  int found_count_ = 0;
};

}  // namespace palpate::fem
