// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/frame_pairing.hpp"

#include <iterator>
#include <utility>

namespace palpate::perception {

FrameSet* FramePairing::At(std::int64_t stamp_ns, Time now) {
  if (last_stamp_ns_ && stamp_ns <= *last_stamp_ns_) return nullptr;
  const auto [set, is_new] = sets_.try_emplace(stamp_ns);
  if (!is_new) return &set->second;
  set->second.stamp_ns = stamp_ns;
  set->second.since = now;
  if (sets_.size() > kMostSets) {
    const auto oldest = sets_.begin() == set ? std::next(set) : sets_.begin();
    sets_.erase(oldest);
    ++dropped_;
  }
  return &set->second;
}

std::optional<FrameSet> FramePairing::Take(const std::function<bool(const FrameSet&)>& whole,
                                           Time now) {
  for (auto set = sets_.end(); set != sets_.begin();) {
    if (whole((--set)->second)) return TakeOut(set, now);
  }
  return TakeOverdue(now);
}

std::optional<FrameSet> FramePairing::TakeOverdue(Time now) {
  for (auto set = sets_.begin(); set != sets_.end();) {
    if (now - set->second.since < wait_) {
      ++set;
    } else if (set->second.depth || !set->second.status.ok()) {
      return TakeOut(set, now);
    } else {
      set = sets_.erase(set);
      ++dropped_;
    }
  }
  return std::nullopt;
}

std::optional<FramePairing::Time> FramePairing::NextOverdue() const {
  std::optional<Time> next;
  for (const auto& [stamp_ns, set] : sets_) {
    const Time overdue = set.since + wait_;
    if (!next || overdue < *next) next = overdue;
  }
  return next;
}

FrameSet FramePairing::TakeOut(Sets::iterator set, Time now) {
  FrameSet taken = std::move(set->second);
  taken.taken = now;
  last_stamp_ns_ = taken.stamp_ns;
  dropped_ += static_cast<std::uint64_t>(std::distance(sets_.begin(), set));
  sets_.erase(sets_.begin(), std::next(set));
  return taken;
}

void FramePairing::Restart(std::int64_t first_stamp_ns, std::uint32_t epoch) {
  last_stamp_ns_.reset();
  dropped_ += std::erase_if(sets_, [&](const Sets::value_type& entry) {
    const FrameSet& set = entry.second;
    return set.stamp_ns < first_stamp_ns || (set.facts && set.facts->epoch != epoch);
  });
}

}  // namespace palpate::perception
