// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/minimum_fill.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/index.hpp"

namespace palpate::fem::internal {

namespace {

/// The graph of what is left of a matrix after some nodes were eliminated.
class EliminationGraph {
 public:
  explicit EliminationGraph(const NodeGraph& graph) {
    mark_.assign(At(graph.NodeCount()), -1);
    missing_.assign(mark_.size(), 0);
    score_.assign(mark_.size(), 0.0);
    for (int node = 0; node < graph.NodeCount(); ++node) {
      neighbours_.emplace_back(graph.neighbours.begin() + graph.start[At(node)],
                               graph.neighbours.begin() + graph.start[At(node) + 1]);
    }
    for (int node = 0; node < graph.NodeCount(); ++node) CountMissing(node);
    UpdateScores();
  }

  /// Neighbours that were visited so far.
  long work() const { return work_; }

  int Best() {
    work_ += static_cast<long>(score_.size());
    return static_cast<int>(std::min_element(score_.begin(), score_.end()) - score_.begin());
  }

  void Eliminate(int node) {
    const std::vector<int> around = std::move(neighbours_[At(node)]);
    neighbours_[At(node)] = {};
    Forget(node, around);
    for (size_t k = 0; k < around.size(); ++k) Connect(around[k], around, k + 1);
    UpdateScores();
    score_[At(node)] = std::numeric_limits<double>::infinity();
  }

 private:
  const std::vector<int>& Neighbours(int node) const { return neighbours_[At(node)]; }

  /// From here on, IsMarked(n) is whether n is one of `nodes`.
  void Mark(const std::vector<int>& nodes) {
    ++stamp_;
    for (const int node : nodes) mark_[At(node)] = stamp_;
    work_ += static_cast<long>(nodes.size());
  }
  bool IsMarked(int node) const { return mark_[At(node)] == stamp_; }

  void AddMissing(int node, long pairs) {
    if (pairs == 0) return;
    missing_[At(node)] += pairs;
    changed_.push_back(node);
  }

  void CountMissing(int node) {
    Mark(Neighbours(node));
    const auto degree = static_cast<long>(Neighbours(node).size());
    long connected = 0;
    for (const int neighbour : Neighbours(node)) {
      for (const int other : Neighbours(neighbour)) connected += IsMarked(other) ? 1 : 0;
    }
    missing_[At(node)] = (degree * (degree - 1) - connected) / 2;
    changed_.push_back(node);
  }

  /// Takes the node out of its neighbours' lists, and its pairs out of what they miss.
  void Forget(int node, const std::vector<int>& around) {
    Mark(around);
    for (const int neighbour : around) {
      std::vector<int>& list = neighbours_[At(neighbour)];
      const auto place = std::find(list.begin(), list.end(), node);
      *place = list.back();
      list.pop_back();
      work_ += 2 * static_cast<long>(list.size());
      const auto apart =
          std::count_if(list.begin(), list.end(), [&](int other) { return !IsMarked(other); });
      missing_[At(neighbour)] -= apart;
      changed_.push_back(neighbour);
    }
  }

  /// Connects a node with those of `around` from place `first` on that it is not connected with.
  void Connect(int node, const std::vector<int>& around, size_t first) {
    Mark(Neighbours(node));
    for (size_t k = first; k < around.size(); ++k) {
      const int other = around[k];
      if (IsMarked(other)) continue;
      long common = 0;
      for (const int neighbour : Neighbours(other)) {
        if (!IsMarked(neighbour)) continue;
        ++common;
        AddMissing(neighbour, -1);
      }
      work_ += static_cast<long>(Neighbours(other).size());
      AddMissing(node, static_cast<long>(Neighbours(node).size()) - common);
      AddMissing(other, static_cast<long>(Neighbours(other).size()) - common);
      neighbours_[At(node)].push_back(other);
      neighbours_[At(other)].push_back(node);
      mark_[At(other)] = stamp_;
    }
  }

  void UpdateScores() {
    for (const int node : changed_) {
      score_[At(node)] = static_cast<double>(missing_[At(node)]) /
                         static_cast<double>(Neighbours(node).size() + 1);
    }
    changed_.clear();
  }

  std::vector<std::vector<int>> neighbours_;
  std::vector<int> mark_;
  std::vector<long> missing_;  ///< pairs of neighbours that are not connected
  std::vector<double> score_;
  std::vector<int> changed_;
  int stamp_ = 0;
  long work_ = 0;
};

}  // namespace

std::vector<int> MinimumMeanFillOrder(const NodeGraph& graph) {
  constexpr long kMostWork = 500'000'000;
  EliminationGraph left(graph);
  std::vector<int> order;
  while (static_cast<int>(order.size()) < graph.NodeCount()) {
    if (left.work() > kMostWork) return {};
    order.push_back(left.Best());
    left.Eliminate(order.back());
  }
  return order;
}

}  // namespace palpate::fem::internal
