// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/watch.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace palpate::test_support {

namespace {

constexpr double kNever_N = std::numeric_limits<double>::infinity();

double SmallestTrueForce_N(const SceneState& state) {
  double smallest_N = kNever_N;
  for (const auto& force : state.forces) smallest_N = std::min(smallest_N, force.force_N.norm());
  return smallest_N;
}

}  // namespace

void Watch(const std::vector<SceneState>& path, const WatchPlan& plan, SensingScene& scene,
           SensingChain& chain, Watched* watched) {
  double found_from_N = kNever_N;
  const auto look = [&](const SceneState& state, Accuracy* accuracy) {
    scene.Show(state);
    const force_estimation::ForceEstimate& estimate = chain.Take();
    accuracy->Add(state.forces, estimate);
    return estimate.status.ok() && estimate.contacts.size() >= state.forces.size();
  };
  for (const SceneState& state : path) {
    const bool found = look(state, &watched->underway);
    if (state.forces.empty() || !found) {
      found_from_N = kNever_N;
    } else if (found_from_N == kNever_N) {
      found_from_N = SmallestTrueForce_N(state);
    }
  }
  watched->found_from_N.push_back(found_from_N);
  for (int k = 0; k < plan.settle; ++k) look(path.back(), &watched->underway);
  watched->held.BeginContacts();
  for (int k = 0; k < plan.measured; ++k) look(path.back(), &watched->held);
  for (std::size_t k = path.size(); k > 0; k -= std::min<std::size_t>(k, 2)) {
    look(path[k - 1], &watched->underway);
  }
  for (int k = 0; k < plan.rest; ++k) look(path.front(), &watched->underway);
}

}  // namespace palpate::test_support
