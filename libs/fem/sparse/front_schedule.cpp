// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/front_schedule.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "libs/core/index.hpp"
#include "libs/fem/sparse/amalgamation.hpp"

namespace palpate::fem::internal {

namespace {

/// Offsets in a buffer for blocks that come and go in a known order: each takes the first gap that
/// is large enough.
class OffsetPlan {
 public:
  size_t Take(size_t size) {
    size_t offset = 0;
    auto place = taken_.begin();
    for (; place != taken_.end() && place->offset - offset < size; ++place) {
      offset = place->offset + place->size;
    }
    taken_.insert(place, {offset, size});
    end_ = std::max(end_, offset + size);
    return offset;
  }
  void Release(size_t offset) {
    taken_.erase(std::find_if(taken_.begin(), taken_.end(), [&](const Taken& taken) {
      return taken.offset == offset && taken.size > 0;
    }));
  }
  size_t end() const { return end_; }

 private:
  struct Taken {
    size_t offset;
    size_t size;
  };
  std::vector<Taken> taken_;
  size_t end_ = 0;
};

/// Costs of whole subtrees.
std::vector<double> SubtreeCosts(const FrontTree& tree) {
  std::vector<double> costs(tree.fronts().size(), 0.0);
  for (size_t f = 0; f < costs.size(); ++f) {
    const Front& front = tree.fronts()[f];
    costs[f] += FrontCost(front.pivot_nodes, front.Below() / 3);
    if (front.parent >= 0) costs[At(front.parent)] += costs[f];
  }
  return costs;
}

struct Assignment {
  std::vector<std::vector<int>> roots;  ///< [threads] of subtrees
  double longest = 0.0;
};

/// The largest subtree first, each to the thread that has least to do.
Assignment Distribute(std::vector<int> roots, const std::vector<double>& costs, int threads) {
  std::stable_sort(roots.begin(), roots.end(),
                   [&](int a, int b) { return costs[At(a)] > costs[At(b)]; });
  Assignment assignment;
  assignment.roots.resize(At(threads));
  std::vector<double> load(At(threads), 0.0);
  for (const int root : roots) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += costs[At(root)];
    assignment.roots[At(least - load.begin())].push_back(root);
  }
  assignment.longest = *std::max_element(load.begin(), load.end());
  return assignment;
}

/// Opens the largest subtree again and again, its root going to those worked on together, and keeps
/// the division that is expected to take the shortest time.
Assignment DivideTree(const FrontTree& tree, int threads) {
  const std::vector<double> costs = SubtreeCosts(tree);
  std::vector<int> roots;
  for (size_t f = 0; f < costs.size(); ++f) {
    if (tree.fronts()[f].parent < 0) roots.push_back(static_cast<int>(f));
  }
  if (threads == 1) return Distribute(roots, costs, 1);
  // What a front worked on together gains from a second thread, less than a second time as much.
  constexpr double kSharedEfficiency = 0.7;
  constexpr double kPerSharedFront = 4000.0;
  Assignment best;
  double best_time = std::numeric_limits<double>::infinity();
  double together = 0.0;
  for (;;) {
    Assignment candidate = Distribute(roots, costs, threads);
    const double time = candidate.longest + together;
    if (time < best_time) {
      best_time = time;
      best = std::move(candidate);
    }
    const auto largest = std::max_element(
        roots.begin(), roots.end(), [&](int a, int b) { return costs[At(a)] < costs[At(b)]; });
    if (largest == roots.end() || together > best_time) return best;
    const int opened = *largest;
    roots.erase(largest);
    double own = costs[At(opened)];
    for (const int child : tree.fronts()[At(opened)].children) {
      roots.push_back(child);
      own -= costs[At(child)];
    }
    together += own / (1.0 + kSharedEfficiency * (threads - 1)) + kPerSharedFront;
  }
}

}  // namespace

FrontSchedule ScheduleFronts(const FrontTree& tree, int threads) {
  const auto count = static_cast<int>(tree.fronts().size());
  FrontSchedule schedule;
  schedule.own.resize(At(threads));
  std::vector<int> owner(At(count), -1);
  const Assignment assignment = DivideTree(tree, threads);
  for (int thread = 0; thread < static_cast<int>(assignment.roots.size()); ++thread) {
    for (const int root : assignment.roots[At(thread)]) owner[At(root)] = thread;
  }
  for (int f = count - 1; f >= 0; --f) {
    const int parent = tree.fronts()[At(f)].parent;
    if (owner[At(f)] < 0 && parent >= 0) owner[At(f)] = owner[At(parent)];
  }
  for (int f = 0; f < count; ++f) {
    (owner[At(f)] < 0 ? schedule.together : schedule.own[At(owner[At(f)])]).push_back(f);
  }

  // Threads run at the same time, so each has a part of the buffer to itself; the updates that the
  // shared fronts take over stay where they are.
  schedule.update_offset.resize(At(count));
  const auto plan = [&](const std::vector<int>& fronts, int part) {
    OffsetPlan offsets;
    for (const int f : fronts) {
      const Front& front = tree.fronts()[At(f)];
      if (front.UpdateSize() > 0) {
        schedule.update_offset[At(f)] = schedule.update_size + offsets.Take(front.UpdateSize());
      }
      for (const int child : front.children) {
        if (owner[At(child)] != part || tree.fronts()[At(child)].UpdateSize() == 0) continue;
        offsets.Release(schedule.update_offset[At(child)] - schedule.update_size);
      }
    }
    schedule.update_size += offsets.end();
  };
  for (int thread = 0; thread < threads; ++thread) plan(schedule.own[At(thread)], thread);
  plan(schedule.together, -1);
  return schedule;
}

}  // namespace palpate::fem::internal
