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

/// The first sample that is not before `t_s`.
std::vector<TruthTimeline::Sample>::const_iterator TruthTimeline::NotBefore(double t_s) const {
  return std::lower_bound(samples_.begin(), samples_.end(), t_s,
                          [](const Sample& sample, double time_s) { return sample.t_s < time_s; });
}

/// The nearest sample of the same time, nullptr where there is none.
const TruthTimeline::Sample* TruthTimeline::SampleAt(double t_s) const {
  const auto after = NotBefore(t_s);
  const Sample* nearest = after == samples_.end() ? nullptr : &*after;
  if (after != samples_.begin()) {
    const Sample& before = *(after - 1);
    if (nearest == nullptr || t_s - before.t_s < nearest->t_s - t_s) nearest = &before;
  }
  return nearest && std::abs(nearest->t_s - t_s) <= timing_.same_time_s ? nearest : nullptr;
}

std::optional<std::vector<TrueContact>> TruthTimeline::HeldAt(double t_s) const {
  if (samples_.empty()) return std::nullopt;
  if (samples_.size() == 1) return samples_.front().contacts;
  const auto next =
      std::upper_bound(samples_.begin(), samples_.end(), t_s,
                       [](double time_s, const Sample& sample) { return time_s < sample.t_s; });
  return next == samples_.begin() ? std::vector<TrueContact>() : (next - 1)->contacts;
}

std::optional<std::vector<TrueContact>> TruthTimeline::At(double t_s) const {
  if (timing_.holds) return HeldAt(t_s);
  if (const Sample* sample = SampleAt(t_s)) return sample->contacts;
  const auto after = NotBefore(t_s);
  if (after == samples_.end() || after == samples_.begin()) return std::nullopt;
  const Sample& before = *(after - 1);
  const double gap_s = after->t_s - before.t_s;
  if (gap_s > timing_.longest_gap_s) return std::nullopt;
  return Between(before.contacts, after->contacts, (t_s - before.t_s) / gap_s);
}

bool TruthTimeline::IsSteady(const std::string& name, double t_s, double window_s,
                             double share) const {
  const auto now = At(t_s);
  const auto then = At(t_s - window_s);
  if (!now || !then) return false;
  std::vector<const std::vector<TrueContact>*> samples = {&*then, &*now};
  for (auto sample = NotBefore(t_s - window_s); sample != samples_.end(); ++sample) {
    if (sample->t_s >= t_s) break;
    if (sample->t_s > t_s - window_s) samples.push_back(&sample->contacts);
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

std::vector<double> TruthTimeline::times_s() const {
  std::vector<double> times_s;
  for (const Sample& sample : samples_) times_s.push_back(sample.t_s);
  return times_s;
}

double TruthTimeline::LargestForce_N() const {
  double largest_N = 0.0;
  for (const Sample& sample : samples_) {
    for (const TrueContact& contact : sample.contacts) {
      largest_N = std::max(largest_N, contact.force_N.norm());
    }
  }
  return largest_N;
}

double TruthTimeline::LongestPeriod_s() const {
  double longest_s = 0.0;
  for (std::size_t i = 1; i < samples_.size() && !timing_.holds; ++i) {
    longest_s = std::max(longest_s, samples_[i].t_s - samples_[i - 1].t_s);
  }
  return longest_s;
}

}  // namespace palpate::command
