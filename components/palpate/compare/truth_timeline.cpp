// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/truth_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate::command {

namespace {

const TrueContact* Find(const std::vector<TrueContact>& contacts, const std::string& name) {
  const auto found = std::find_if(contacts.begin(), contacts.end(),
                                  [&](const TrueContact& contact) { return contact.name == name; });
  return found == contacts.end() ? nullptr : &*found;
}

std::vector<TrueContact> Between(const std::vector<TrueContact>& before,
                                 const std::vector<TrueContact>& after, double share) {
  std::vector<TrueContact> contacts;
  for (const TrueContact& contact : before) {
    if (const TrueContact* later = Find(after, contact.name)) {
      contacts.push_back({contact.name,
                          (1.0 - share) * contact.position_m + share * later->position_m,
                          (1.0 - share) * contact.force_N + share * later->force_N});
    } else if (share < 0.5) {
      contacts.push_back(contact);
    }
  }
  for (const TrueContact& contact : after) {
    if (share >= 0.5 && Find(before, contact.name) == nullptr) contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace

void TruthTimeline::Add(double t_s, std::vector<TrueContact> contacts) {
  if (!samples_.empty() && !(t_s > samples_.back().t_s)) return;
  samples_.push_back({t_s, std::move(contacts)});
}

/// The nearest sample of the same time, nullptr where there is none.
const TruthTimeline::Sample* TruthTimeline::SampleAt(double t_s) const {
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), t_s,
                       [](const Sample& sample, double time_s) { return sample.t_s < time_s; });
  const Sample* nearest = after == samples_.end() ? nullptr : &*after;
  if (after != samples_.begin()) {
    const Sample& before = *(after - 1);
    if (nearest == nullptr || t_s - before.t_s < nearest->t_s - t_s) nearest = &before;
  }
  return nearest && std::abs(nearest->t_s - t_s) <= kSameTime_s ? nearest : nullptr;
}

std::optional<std::vector<TrueContact>> TruthTimeline::At(double t_s) const {
  if (const Sample* sample = SampleAt(t_s)) return sample->contacts;
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), t_s,
                       [](const Sample& sample, double time_s) { return sample.t_s < time_s; });
  if (after == samples_.end() || after == samples_.begin()) return std::nullopt;
  const Sample& before = *(after - 1);
  const double gap_s = after->t_s - before.t_s;
  if (gap_s > kLongestGap_s) return std::nullopt;
  return Between(before.contacts, after->contacts, (t_s - before.t_s) / gap_s);
}

bool TruthTimeline::IsSteady(const std::string& name, double t_s, double window_s,
                             double share) const {
  const auto now = At(t_s);
  const auto then = At(t_s - window_s);
  if (!now || !then) return false;
  std::vector<const std::vector<TrueContact>*> samples = {&*then, &*now};
  for (const Sample& sample : samples_) {
    if (sample.t_s > t_s - window_s && sample.t_s < t_s) samples.push_back(&sample.contacts);
  }
  double smallest_N = std::numeric_limits<double>::infinity();
  double largest_N = 0.0;
  for (const std::vector<TrueContact>* contacts : samples) {
    const TrueContact* contact = Find(*contacts, name);
    if (contact == nullptr) return false;
    smallest_N = std::min(smallest_N, contact->force_N.norm());
    largest_N = std::max(largest_N, contact->force_N.norm());
  }
  return largest_N - smallest_N <= share * largest_N;
}

}  // namespace palpate::command
