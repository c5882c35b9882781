// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/frame_joining.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/statistics.hpp"

namespace palpate::perception {

FrameJoining::FrameJoining(std::size_t cameras, std::chrono::steady_clock::duration wait,
                           const FrameJoiningTuning& tuning)
    : cameras_(cameras), wait_(wait), tuning_(tuning) {}

void FrameJoining::Add(std::size_t camera, FrameSet set) {
  std::deque<std::int64_t>& stamps_ns = cameras_[camera].stamps_ns;
  if (!stamps_ns.empty() && set.stamp_ns <= stamps_ns.back()) {
    for (Camera& one : cameras_) {
      dropped_ += one.waiting.size();
      one = {};
    }
    last_stamp_ns_.reset();
  }
  stamps_ns.push_back(set.stamp_ns);
  if (stamps_ns.size() > tuning_.periods + 1) stamps_ns.pop_front();
  cameras_[camera].misses = 0;
  const auto& missed_until_ns = cameras_[camera].missed_until_ns;
  if (missed_until_ns && set.stamp_ns <= *missed_until_ns) {
    ++dropped_;
    return;
  }
  cameras_[camera].waiting.push_back(std::move(set));
}

std::optional<std::int64_t> FrameJoining::Period_ns(const Camera& camera) const {
  std::vector<double> periods_ns;
  for (std::size_t k = 1; k < camera.stamps_ns.size(); ++k) {
    periods_ns.push_back(static_cast<double>(camera.stamps_ns[k] - camera.stamps_ns[k - 1]));
  }
  if (periods_ns.empty()) return std::nullopt;
  return static_cast<std::int64_t>(Median(periods_ns));
}

std::int64_t FrameJoining::LongestApart_ns() const {
  double longest_ns = 1e9 * tuning_.together.longest_apart_s;
  for (const Camera& camera : cameras_) {
    const auto period_ns = Period_ns(camera);
    if (!period_ns) continue;
    longest_ns =
        std::min(longest_ns, tuning_.together.share_of_period * static_cast<double>(*period_ns));
  }
  return static_cast<std::int64_t>(longest_ns);
}

bool FrameJoining::MayCome(const Camera& camera, std::int64_t end_ns,
                           std::int64_t longest_ns) const {
  if (camera.misses >= tuning_.misses) return false;
  if (camera.stamps_ns.empty()) return true;
  if (camera.stamps_ns.back() > end_ns) return false;
  // Cameras of another rate have no set in every frame.
  const auto period_ns = Period_ns(camera);
  return !period_ns || camera.stamps_ns.back() + *period_ns - longest_ns / 2 <= end_ns;
}

const FrameSet* FrameJoining::Earliest() const {
  const FrameSet* earliest = nullptr;
  for (const Camera& camera : cameras_) {
    if (camera.waiting.empty()) continue;
    const FrameSet& set = camera.waiting.front();
    if (earliest == nullptr || set.stamp_ns < earliest->stamp_ns) earliest = &set;
  }
  return earliest;
}

std::optional<JointSet> FrameJoining::Take(Time now) {
  while (auto joint = TakeNext(now)) {
    if (!last_stamp_ns_ || joint->stamp_ns > *last_stamp_ns_) {
      last_stamp_ns_ = joint->stamp_ns;
      return joint;
    }
    // Before the periods are known, sets that are far apart may have been joined.
    ++dropped_;
  }
  return std::nullopt;
}

std::optional<JointSet> FrameJoining::TakeNext(Time now) {
  const FrameSet* earliest = Earliest();
  if (earliest == nullptr) return std::nullopt;
  const std::int64_t longest_ns = cameras_.size() > 1 ? LongestApart_ns() : 0;
  const std::int64_t end_ns = earliest->stamp_ns + longest_ns;
  const bool is_overdue = now - earliest->taken >= wait_;
  for (const Camera& camera : cameras_) {
    const bool waits = camera.waiting.empty() && MayCome(camera, end_ns, longest_ns);
    if (waits && !is_overdue) return std::nullopt;
  }
  return Join(end_ns, longest_ns, now);
}

JointSet FrameJoining::Join(std::int64_t end_ns, std::int64_t longest_ns, Time now) {
  JointSet joint{.stamp_ns = 0, .sets = {}, .taken = now};
  bool has_set = false;
  // Before a period is known, the next set of a camera may be as near as a late one.
  const bool knows_period = std::any_of(cameras_.begin(), cameras_.end(), [this](const auto& one) {
    return Period_ns(one).has_value();
  });
  const std::int64_t missed_until_ns = knows_period ? end_ns : end_ns - longest_ns;
  for (Camera& camera : cameras_) {
    std::optional<FrameSet>& set = joint.sets.emplace_back();
    camera.missed_until_ns = missed_until_ns;
    if (camera.waiting.empty()) {
      if (MayCome(camera, end_ns, longest_ns)) ++camera.misses;
    } else if (camera.waiting.front().stamp_ns <= end_ns) {
      set = std::move(camera.waiting.front());
      camera.waiting.pop_front();
      camera.missed_until_ns.reset();
      if (!std::exchange(has_set, true)) joint.stamp_ns = set->stamp_ns;
    }
  }
  return joint;
}

std::optional<FrameJoining::Time> FrameJoining::NextOverdue() const {
  const FrameSet* earliest = Earliest();
  if (earliest == nullptr) return std::nullopt;
  return earliest->taken + wait_;
}

}  // namespace palpate::perception
