// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/minimum_fill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace palpate::fem::internal {
namespace {

/// Edges that eliminating the nodes in this order adds, counted the slow way.
int Fill(int node_count, const NodePairs& pairs, const std::vector<int>& order) {
  std::vector<std::set<int>> neighbours(static_cast<size_t>(node_count));
  const auto of = [&](int node) -> std::set<int>& { return neighbours[static_cast<size_t>(node)]; };
  for (const auto& [a, b] : pairs) {
    of(a).insert(b);
    of(b).insert(a);
  }
  int fill = 0;
  for (const int node : order) {
    for (const int a : of(node)) {
      of(a).erase(node);
      for (const int b : of(node)) fill += a < b && of(a).insert(b).second ? 1 : 0;
      for (const int b : of(node)) {
        if (b != a) of(b).insert(a);
      }
    }
  }
  return fill;
}

std::vector<int> OrderOf(int node_count, const NodePairs& pairs) {
  std::vector<int> order = MinimumMeanFillOrder(MakeNodeGraph(node_count, pairs));
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted.size(), static_cast<size_t>(node_count));
  for (int k = 0; k < static_cast<int>(sorted.size()); ++k) {
    EXPECT_EQ(sorted[static_cast<size_t>(k)], k);
  }
  return order;
}

TEST(MinimumMeanFillOrder, AddsNothingToATree) {
  constexpr int kNodes = 60;
  std::mt19937 engine(1);
  NodePairs pairs;
  for (int node = 1; node < kNodes; ++node) {
    pairs.emplace_back(node, std::uniform_int_distribution<int>(0, node - 1)(engine));
  }
  EXPECT_EQ(Fill(kNodes, pairs, OrderOf(kNodes, pairs)), 0);
}

TEST(MinimumMeanFillOrder, AddsNothingToOverlappingCliques) {
  // Of four nodes each, a chain: chordal, so that there is an order without fill.
  constexpr int kNodes = 31;
  NodePairs pairs;
  for (int first = 0; first + 3 < kNodes; first += 3) {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < a; ++b) pairs.emplace_back(first + a, first + b);
    }
  }
  EXPECT_EQ(Fill(kNodes, pairs, OrderOf(kNodes, pairs)), 0);
}

TEST(MinimumMeanFillOrder, AddsToARingWhatAnyOrderMust) {
  constexpr int kNodes = 20;
  NodePairs pairs;
  for (int node = 0; node < kNodes; ++node) pairs.emplace_back(node, (node + 1) % kNodes);
  EXPECT_EQ(Fill(kNodes, pairs, OrderOf(kNodes, pairs)), kNodes - 3);
}

TEST(MinimumMeanFillOrder, AddsMuchLessToAGridThanTheOrderOfItsRows) {
  constexpr int kSide = 16;
  NodePairs pairs;
  std::vector<int> rows;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      rows.push_back(i * kSide + j);
      if (j + 1 < kSide) pairs.emplace_back(i * kSide + j, i * kSide + j + 1);
      if (i + 1 < kSide) pairs.emplace_back(i * kSide + j, (i + 1) * kSide + j);
    }
  }
  constexpr int kNodes = kSide * kSide;
  EXPECT_LT(2 * Fill(kNodes, pairs, OrderOf(kNodes, pairs)), Fill(kNodes, pairs, rows));
}

TEST(MinimumMeanFillOrder, TakesNodesWithoutNeighbours) {
  EXPECT_EQ(OrderOf(3, {}).size(), 3U);
  EXPECT_TRUE(OrderOf(0, {}).empty());
}

TEST(MinimumMeanFillOrder, GivesUpOnGraphsThatWouldTakeTooLong) {
  constexpr int kNodes = 40000;
  NodePairs pairs;
  for (int node = 1; node < kNodes; ++node) pairs.emplace_back(node - 1, node);
  EXPECT_TRUE(MinimumMeanFillOrder(MakeNodeGraph(kNodes, pairs)).empty());
}

}  // namespace
}  // namespace palpate::fem::internal
