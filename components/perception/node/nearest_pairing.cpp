// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/nearest_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace palpate::perception {

void StreamPeriod::Add(std::int64_t stamp_ns) {
  if (last_ns_) steps_ns_.push_back(stamp_ns - *last_ns_);
  if (steps_ns_.size() > kMostSteps) steps_ns_.pop_front();
  last_ns_ = stamp_ns;
}

std::optional<std::int64_t> StreamPeriod::period_ns() const {
  if (steps_ns_.size() < 3) return std::nullopt;
  std::vector<std::int64_t> sorted(steps_ns_.begin(), steps_ns_.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

NearestPairing::NearestPairing(std::chrono::steady_clock::duration wait, double tolerance_s)
    : wait_(wait), given_tolerance_ns_(std::llround(1e9 * tolerance_s)) {}

bool NearestPairing::AddDepth(FrameSet set, Time now) {
  if (last_depth_ns_ == set.stamp_ns) return false;
  if (last_depth_ns_ && set.stamp_ns < *last_depth_ns_) {
    dropped_ += depths_.size();
    depths_.clear();
    colors_.clear();
    depth_period_.Clear();
    color_period_.Clear();
    last_stamp_ns_.reset();
  }
  last_depth_ns_ = set.stamp_ns;
  depth_period_.Add(set.stamp_ns);
  set.since = now;
  depths_.push_back(std::move(set));
  if (depths_.size() > kMostDepths) {
    depths_.pop_front();
    ++dropped_;
  }
  return true;
}

void NearestPairing::AddColor(std::int64_t stamp_ns, rgbd::ColorImage image, const Status& status) {
  if (!colors_.empty() && stamp_ns <= colors_.back().stamp_ns) {
    if (stamp_ns == colors_.back().stamp_ns) return;
    colors_.clear();  // the stream began again
    color_period_.Clear();
  }
  color_period_.Add(stamp_ns);
  colors_.push_back({stamp_ns, std::move(image), status});
  if (colors_.size() > kMostColors) colors_.pop_front();
}

std::optional<std::int64_t> NearestPairing::tolerance_ns() const {
  if (given_tolerance_ns_ > 0) return given_tolerance_ns_;
  const auto depth_ns = depth_period_.period_ns(), color_ns = color_period_.period_ns();
  if (!depth_ns || !color_ns) return std::nullopt;
  return std::max(*depth_ns, *color_ns) * 3 / 4;
}

const NearestPairing::Color* NearestPairing::Nearest(std::int64_t stamp_ns) const {
  const Color* nearest = nullptr;
  for (const Color& color : colors_) {
    const auto away_ns = std::abs(color.stamp_ns - stamp_ns);
    if (!nearest || away_ns < std::abs(nearest->stamp_ns - stamp_ns)) nearest = &color;
  }
  const auto tolerance = tolerance_ns();
  const bool is_near =
      nearest && (!tolerance || std::abs(nearest->stamp_ns - stamp_ns) <= *tolerance);
  return is_near ? nearest : nullptr;
}

/// Later colour images are only farther away.
bool NearestPairing::IsDecided(std::int64_t stamp_ns) const {
  return !colors_.empty() && colors_.back().stamp_ns >= stamp_ns;
}

std::optional<FrameSet> NearestPairing::Take(bool with_color, Time now) {
  for (std::size_t i = depths_.size(); i-- > 0;) {
    const FrameSet& set = depths_[i];
    if (!with_color || !set.status.ok() || (IsDecided(set.stamp_ns) && Nearest(set.stamp_ns))) {
      return TakeOut(i, now);
    }
  }
  if (depths_.empty()) return std::nullopt;
  const FrameSet& oldest = depths_.front();
  if (!IsDecided(oldest.stamp_ns) && now - oldest.since < wait_) return std::nullopt;
  return TakeOut(0, now);
}

std::optional<NearestPairing::Time> NearestPairing::NextOverdue() const {
  if (depths_.empty()) return std::nullopt;
  return depths_.front().since + wait_;
}

FrameSet NearestPairing::TakeOut(std::size_t index, Time now) {
  const auto at = depths_.begin() + static_cast<std::ptrdiff_t>(index);
  FrameSet set = std::move(*at);
  dropped_ += index;
  depths_.erase(depths_.begin(), at + 1);
  set.taken = now;
  if (const Color* color = Nearest(set.stamp_ns)) {
    set.color = color->image;
    if (set.status.ok()) set.status = color->status;
  }
  last_stamp_ns_ = set.stamp_ns;
  return set;
}

}  // namespace palpate::perception
