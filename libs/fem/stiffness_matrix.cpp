// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/stiffness_matrix.hpp"

#include <algorithm>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/sparse/recent_orders.hpp"

namespace palpate::fem {

namespace {

/// The process's own.
EliminationOrder FindOrder(int node_count, const NodePairs& pairs) {
  static RecentOrders recent;
  return recent.Find(node_count, pairs);
}

}  // namespace

StiffnessMatrix::StiffnessMatrix(const Eigen::Matrix<bool, 3, Eigen::Dynamic>& fixed,
                                 const NodePairs& pairs)
    : free_index_(static_cast<size_t>(fixed.cols()), -1) {
  std::vector<int> node_of_graph;
  for (int node = 0; node < static_cast<int>(fixed.cols()); ++node) {
    if (fixed.col(node).all()) continue;
    free_index_[At(node)] = free_node_count_++;
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
  EliminationOrder order = FindOrder(free_node_count_, free_pairs);
  supernode_start_ = std::move(order.supernode_start);
  std::vector<int> place(order.nodes.size());
  for (size_t k = 0; k < order.nodes.size(); ++k) place[At(order.nodes[k])] = static_cast<int>(k);
  for (int node : node_of_graph) {
    int& index = free_index_[At(node)];
    index = place[At(index)];
  }
  for (auto& [a, b] : free_pairs) {
    const int place_a = place[At(a)];
    const int place_b = place[At(b)];
    a = std::min(place_a, place_b);
    b = std::max(place_a, place_b);
  }
  BuildPattern(free_pairs);
  for (int node : node_of_graph) {
    for (int i = 0; i < 3; ++i) {
      if (fixed(i, node)) single_fixed_.push_back(3 * FreeIndex(node) + i);
    }
  }
  is_single_fixed_.assign(At(Size()), false);
  for (const int row : single_fixed_) is_single_fixed_[At(row)] = true;
}

void StiffnessMatrix::BuildPattern(const NodePairs& free_pairs) {
  NodePairs columns = free_pairs;  // (column, row), column <= row
  for (int node = 0; node < free_node_count_; ++node) columns.emplace_back(node, node);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  column_start_.assign(At(free_node_count_) + 1, 0);
  row_.reserve(columns.size());
  for (const auto& [column, row] : columns) {
    ++column_start_[At(column) + 1];
    row_.push_back(row);
  }
  for (size_t j = 1; j < column_start_.size(); ++j) column_start_[j] += column_start_[j - 1];
  values_.assign(kBlockEntries * row_.size(), 0.0);
}

BlockSlot StiffnessMatrix::Slot(int node_a, int node_b) const {
  const int a = FreeIndex(node_a);
  const int b = FreeIndex(node_b);
  if (a < 0 || b < 0) return {};
  const int column = std::min(a, b);
  const auto first = row_.begin() + column_start_[At(column)];
  const auto last = row_.begin() + column_start_[At(column) + 1];
  const auto found = std::lower_bound(first, last, std::max(a, b));
  PALPATE_CHECK(found != last && *found == std::max(a, b), node_a, node_b);
  return {.address = kBlockEntries * static_cast<int>(found - row_.begin()), .transposed = a < b};
}

void StiffnessMatrix::SetZero(int begin, int end) {
  std::fill(values_.begin() + kBlockEntries * column_start_[At(begin)],
            values_.begin() + kBlockEntries * column_start_[At(end)], 0.0);
}

double StiffnessMatrix::MeanDiagonal() const {
  double sum = 0.0;
  for (int node = 0; node < free_node_count_; ++node) {
    const double* block = DiagonalBlock(node);
    sum += block[0] + block[4] + block[8];
  }
  return sum / std::max(1, Size());
}

void StiffnessMatrix::AddRelativeShift(double shift) {
  const double amount = shift * MeanDiagonal();
  for (int node = 0; node < free_node_count_; ++node) {
    double* block = values_.data() + kBlockEntries * At(column_start_[At(node)]);
    for (const int entry : {0, 4, 8}) block[entry] += amount;
  }
}

void StiffnessMatrix::FixSingleDirections() {
  if (single_fixed_.empty()) return;
  for (int column = 0; column < free_node_count_; ++column) {
    for (int k = column_start_[At(column)]; k < column_start_[At(column) + 1]; ++k) {
      double* block = values_.data() + kBlockEntries * At(k);
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          const int i = 3 * row_[At(k)] + r;
          const int j = 3 * column + c;
          // The diagonal entry stays as it is: its size does not matter, and it keeps the scale.
          if (i != j && (IsSingleFixed(i) || IsSingleFixed(j))) block[3 * c + r] = 0.0;
        }
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
  for (int column = 0; column < free_node_count_; ++column) {
    for (int k = column_start_[At(column)]; k < column_start_[At(column) + 1]; ++k) {
      const int row = row_[At(k)];
      const Eigen::Map<const Eigen::Matrix3d> block(values_.data() + kBlockEntries * At(k));
      product.segment<3>(3 * row) += block * reduced.segment<3>(3 * column);
      if (row != column) {
        product.segment<3>(3 * column) += block.transpose() * reduced.segment<3>(3 * row);
      }
    }
  }
  return product;
}

}  // namespace palpate::fem
