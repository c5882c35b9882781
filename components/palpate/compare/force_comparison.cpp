// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/force_comparison.hpp"

#include <algorithm>

#include "libs/core/check.hpp"

namespace palpate::command {

namespace {

using force_estimation::ContactForce;

struct ComparisonTuning {
  /// Of the largest true force: smaller ones may be missed. Larger: fewer forces count.
  double smallest_force = 0.1;
  /// Samples in the window in which a force must be steady. More: only densely sampled truths tell
  /// steady forces from others.
  double samples_in_window = 2.0;
};
constexpr ComparisonTuning kComparisonTuning;

struct Pair {
  double distance_m = 0.0;
  std::size_t truth = 0;
  std::size_t estimate = 0;
};

std::vector<Pair> PairsByDistance(const std::vector<TrueContact>& truth,
                                  const std::vector<ContactForce>& estimates, double farthest_m) {
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < truth.size(); ++t) {
    for (std::size_t e = 0; e < estimates.size(); ++e) {
      const double distance_m = (truth[t].position_m - estimates[e].position_m).norm();
      if (distance_m <= farthest_m) pairs.push_back({distance_m, t, e});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_m < b.distance_m; });
  return pairs;
}

std::vector<ContactForce> WithForce(const std::vector<ContactForce>& contacts) {
  std::vector<ContactForce> found;
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(found), HasForce);
  return found;
}

}  // namespace

double SmallestForce_N(double largest_N) { return kComparisonTuning.smallest_force * largest_N; }

ComparisonRules RulesOf(const std::map<std::string, TruthTimeline>& truth, double same_place_m) {
  ComparisonRules rules;
  rules.same_place_m = same_place_m;
  double largest_N = 0.0;
  double longest_s = 0.0;
  for (const auto& [recording, timeline] : truth) {
    largest_N = std::max(largest_N, timeline.LargestForce_N());
    longest_s = std::max(longest_s, timeline.LongestPeriod_s());
  }
  rules.smallest_N = SmallestForce_N(largest_N);
  if (kComparisonTuning.samples_in_window * longest_s > rules.steady_window_s) {
    rules.steady_window_s = 0.0;
  }
  return rules;
}

std::vector<ComparedForce> CompareFrame(const force_estimation::ForceEstimate& estimate,
                                        const TruthTimeline& truth, const ComparisonRules& rules) {
  const auto true_now = truth.At(estimate.t_s);
  if (!HasResult(estimate.status) || !true_now) return {};
  const std::vector<ContactForce> found = WithForce(estimate.contacts);
  const auto is_large = [&](const TrueContact& contact) {
    const double size_N = contact.force_N.norm();
    return size_N > 0.0 && size_N >= rules.smallest_N;
  };
  const auto large_forces =
      static_cast<int>(std::count_if(true_now->begin(), true_now->end(), is_large));
  std::vector<ComparedForce> compared;
  for (const TrueContact& contact : *true_now) {
    const bool due = is_large(contact) && truth.IsSteady(contact.name, estimate.t_s,
                                                         rules.steady_window_s, rules.steady_share);
    compared.push_back({.t_s = estimate.t_s,
                        .truth = contact,
                        .estimate = std::nullopt,
                        .due = due,
                        .true_forces = large_forces});
  }
  std::vector<bool> taken(found.size(), false);
  for (const Pair& pair : PairsByDistance(*true_now, found, rules.same_place_m)) {
    if (compared[pair.truth].estimate || taken[pair.estimate]) continue;
    compared[pair.truth].estimate = found[pair.estimate];
    taken[pair.estimate] = true;
  }
  for (std::size_t e = 0; e < found.size(); ++e) {
    if (taken[e]) continue;
    compared.push_back({.t_s = estimate.t_s,
                        .truth = std::nullopt,
                        .estimate = found[e],
                        .due = false,
                        .true_forces = large_forces});
  }
  return compared;
}

std::vector<ComparedForce> WithoutTruth(const force_estimation::ForceEstimate& estimate) {
  std::vector<ComparedForce> alone;
  if (!HasResult(estimate.status)) return alone;
  for (const ContactForce& contact : WithForce(estimate.contacts)) {
    ComparedForce force;
    force.t_s = estimate.t_s;
    force.estimate = contact;
    alone.push_back(force);
  }
  return alone;
}

bool HasResult(const Status& status) {
  return status.ok() || status.code() == StatusCode::kNoContact;
}

double ForceError_N(const ComparedForce& force) {
  PALPATE_CHECK(force.truth && force.estimate, force.t_s);
  const Eigen::Vector3d& estimated_N = force.estimate->force_N;
  const double size_N = estimated_N.norm();
  const bool normal_only = force.estimate->status.code() == StatusCode::kTangentialUnobservable;
  if (normal_only && size_N > 0.0) {
    return size_N - force.truth->force_N.dot(estimated_N) / size_N;
  }
  return size_N - force.truth->force_N.norm();
}

}  // namespace palpate::command
