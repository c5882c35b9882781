// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/stiffness_matrix.hpp"

#include <algorithm>

#include "libs/core/check.hpp"

namespace palpate::fem {

StiffnessMatrix::StiffnessMatrix(const Eigen::Matrix<bool, 3, Eigen::Dynamic>& fixed,
                                 const NodePairs& pairs)
    : free_index_(static_cast<size_t>(fixed.cols()), -1) {
  std::vector<int> node_of_graph;
  for (int node = 0; node < static_cast<int>(fixed.cols()); ++node) {
    if (fixed.col(node).all()) continue;
    free_index_[static_cast<size_t>(node)] = free_node_count_++;
    node_of_graph.push_back(node);
  }
  NodePairs free_pairs;
  free_pairs.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    if (FreeIndex(a) >= 0 && FreeIndex(b) >= 0 && a != b) {
      free_pairs.emplace_back(FreeIndex(a), FreeIndex(b));
    }
  }
  std::sort(free_pairs.begin(), free_pairs.end());
  free_pairs.erase(std::unique(free_pairs.begin(), free_pairs.end()), free_pairs.end());
  const std::vector<int> order = FillReducingOrder(free_node_count_, free_pairs);
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) {
    place[static_cast<size_t>(order[k])] = static_cast<int>(k);
  }
  for (int node : node_of_graph) {
    int& index = free_index_[static_cast<size_t>(node)];
    index = place[static_cast<size_t>(index)];
  }
  for (auto& [a, b] : free_pairs) {
    const int place_a = place[static_cast<size_t>(a)];
    const int place_b = place[static_cast<size_t>(b)];
    a = std::min(place_a, place_b);
    b = std::max(place_a, place_b);
  }
  BuildPattern(free_pairs);
  for (int node : node_of_graph) {
    for (int i = 0; i < 3; ++i) {
      if (fixed(i, node)) single_fixed_.push_back(3 * FreeIndex(node) + i);
    }
  }
  std::sort(single_fixed_.begin(), single_fixed_.end());
}

void StiffnessMatrix::BuildPattern(const NodePairs& free_pairs) {
  NodePairs columns = free_pairs;  // (column, row), column < row
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  block_start_.assign(static_cast<size_t>(free_node_count_) + 1, 0);
  for (const auto& [column, row] : columns) {
    ++block_start_[static_cast<size_t>(column) + 1];
    block_row_.push_back(row);
  }
  for (size_t j = 1; j < block_start_.size(); ++j) block_start_[j] += block_start_[j - 1];

  column_start_.reserve(static_cast<size_t>(Size()) + 1);
  column_start_.push_back(0);
  for (int column = 0; column < free_node_count_; ++column) {
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) row_.push_back(3 * column + r);
      for (int k = block_start_[static_cast<size_t>(column)];
           k < block_start_[static_cast<size_t>(column) + 1]; ++k) {
        for (int r = 0; r < 3; ++r) row_.push_back(3 * block_row_[static_cast<size_t>(k)] + r);
      }
      column_start_.push_back(static_cast<int>(row_.size()));
    }
  }
  values_.assign(row_.size(), 0.0);
}

BlockSlot StiffnessMatrix::Slot(int node_a, int node_b) const {
  const int a = FreeIndex(node_a);
  const int b = FreeIndex(node_b);
  if (a < 0 || b < 0) return {};
  const auto column = static_cast<size_t>(std::min(a, b));
  const int start = block_start_[column];
  const int below = block_start_[column + 1] - start;
  const int base = column_start_[3 * column];
  if (a == b) return {.address = base, .below = below, .diagonal = true, .transposed = false};
  const auto first = block_row_.begin() + start;
  const auto found = std::lower_bound(first, first + below, std::max(a, b));
  PALPATE_CHECK(found != first + below && *found == std::max(a, b), node_a, node_b);
  const int k = static_cast<int>(found - first);
  return {.address = base + 3 + 3 * k, .below = below, .diagonal = false, .transposed = a < b};
}

void StiffnessMatrix::SetZero() { std::fill(values_.begin(), values_.end(), 0.0); }

double StiffnessMatrix::MeanDiagonal() const {
  double sum = 0.0;
  for (int j = 0; j < Size(); ++j) {
    sum += values_[static_cast<size_t>(column_start_[static_cast<size_t>(j)])];
  }
  return sum / std::max(1, Size());
}

void StiffnessMatrix::AddRelativeShift(double shift) {
  const double amount = shift * MeanDiagonal();
  for (int j = 0; j < Size(); ++j) {
    values_[static_cast<size_t>(column_start_[static_cast<size_t>(j)])] += amount;
  }
}

void StiffnessMatrix::FixSingleDirections() {
  if (single_fixed_.empty()) return;
  const auto is_fixed = [&](int row) {
    return std::binary_search(single_fixed_.begin(), single_fixed_.end(), row);
  };
  for (int j = 0; j < Size(); ++j) {
    const bool column_fixed = is_fixed(j);
    for (int k = column_start_[static_cast<size_t>(j)];
         k < column_start_[static_cast<size_t>(j) + 1]; ++k) {
      const int i = row_[static_cast<size_t>(k)];
      // The diagonal entry stays as it is: its size does not matter, and it keeps the scale.
      if (i != j && (column_fixed || is_fixed(i))) {
        values_[static_cast<size_t>(k)] = 0.0;
      }
    }
  }
}

void StiffnessMatrix::Reduce(const Eigen::Ref<const Eigen::VectorXd>& nodal,
                             Eigen::Ref<Eigen::VectorXd> reduced) const {
  for (int node = 0; node < NodeCount(); ++node) {
    const int index = FreeIndex(node);
    if (index >= 0) reduced.segment<3>(3 * index) = nodal.segment<3>(3 * node);
  }
  for (int row : single_fixed_) reduced[row] = 0.0;
}

void StiffnessMatrix::AddExpanded(const Eigen::Ref<const Eigen::VectorXd>& reduced, double factor,
                                  Eigen::Ref<Eigen::VectorXd> nodal) const {
  for (int node = 0; node < NodeCount(); ++node) {
    const int index = FreeIndex(node);
    if (index >= 0) nodal.segment<3>(3 * node) += factor * reduced.segment<3>(3 * index);
  }
}

Eigen::VectorXd StiffnessMatrix::Times(const Eigen::Ref<const Eigen::VectorXd>& reduced) const {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(Size());
  for (int j = 0; j < Size(); ++j) {
    for (int k = column_start_[static_cast<size_t>(j)];
         k < column_start_[static_cast<size_t>(j) + 1]; ++k) {
      const int i = row_[static_cast<size_t>(k)];
      product[i] += values_[static_cast<size_t>(k)] * reduced[j];
      if (i != j) product[j] += values_[static_cast<size_t>(k)] * reduced[i];
    }
  }
  return product;
}

}  // namespace palpate::fem
