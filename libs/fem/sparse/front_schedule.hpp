// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <vector>

#include "libs/fem/sparse/front_tree.hpp"

namespace palpate::fem::internal {

/// Who works on which front, and where each front's update lies while it is needed.
struct FrontSchedule {
  /// [threads] Fronts of whole subtrees that one thread works on alone, children before parents.
  std::vector<std::vector<int>> own;
  /// Fronts above those subtrees, on which all threads work together afterwards.
  std::vector<int> together;
  std::vector<size_t> update_offset;  ///< [fronts] first entry in a buffer of update_size entries
  size_t update_size = 0;
};

FrontSchedule ScheduleFronts(const FrontTree& tree, int threads);

}  // namespace palpate::fem::internal
