// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/stream/frame_pairing.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace palpate::capture {

namespace {

std::int64_t Difference_ns(const FramePairing::Frame& color, const FramePairing::Frame& depth) {
  return color->facts.stamp_host_ns - depth->facts.stamp_host_ns;
}

FramePairing::Frame Join(FramePairing::Frame depth, const FramePairing::Frame& color) {
  // The images change places, so that both pools keep their memory.
  std::swap(depth->images.color, color->images.color);
  depth->facts.pairing_difference_ns = Difference_ns(color, depth);
  depth->facts.packets_lost += color->facts.packets_lost;
  depth->facts.packets_resent += color->facts.packets_resent;
  return depth;
}

}  // namespace

void FramePairing::Keep(std::deque<Frame>* queue, Frame frame) {
  // A clock that went back, or an epoch that began: the old ones find no partner any more.
  if (!queue->empty() && (queue->back()->facts.stamp_host_ns > frame->facts.stamp_host_ns ||
                          queue->back()->facts.epoch != frame->facts.epoch)) {
    unpaired_ += queue->size();
    queue->clear();
  }
  if (queue->size() == capacity_) {
    queue->pop_front();
    ++unpaired_;
  }
  queue->push_back(std::move(frame));
}

void FramePairing::AddDepth(Frame frame) { Keep(&depth_, std::move(frame)); }
void FramePairing::AddColor(Frame frame) {
  const std::int64_t stamp_ns = frame->facts.stamp_host_ns;
  color_period_ns_ = last_color_ns_ > 0 ? std::max<std::int64_t>(0, stamp_ns - last_color_ns_) : 0;
  last_color_ns_ = stamp_ns;
  Keep(&color_, std::move(frame));
}

void FramePairing::DropColorBefore(std::int64_t stamp_ns) {
  while (!color_.empty() && color_.front()->facts.stamp_host_ns < stamp_ns) {
    color_.pop_front();
    ++unpaired_;
  }
}

std::optional<FramePairing::Frame> FramePairing::Next() {
  while (!depth_.empty()) {
    const std::int64_t stamp_ns = depth_.front()->facts.stamp_host_ns;
    DropColorBefore(stamp_ns - tolerance_ns_);
    if (color_.empty()) return std::nullopt;
    const auto nearest =
        std::min_element(color_.begin(), color_.end(), [&](const Frame& a, const Frame& b) {
          return std::abs(Difference_ns(a, depth_.front())) <
                 std::abs(Difference_ns(b, depth_.front()));
        });
    const std::int64_t difference_ns = Difference_ns(*nearest, depth_.front());
    const bool nearer_may_come = difference_ns < 0 && nearest + 1 == color_.end() &&
                                 color_period_ns_ + difference_ns < -difference_ns;
    if (nearer_may_come && depth_.size() < 2) return std::nullopt;
    Frame depth = std::move(depth_.front());
    depth_.pop_front();
    if (std::abs(difference_ns) > tolerance_ns_) {
      ++unpaired_;
      continue;
    }
    const Frame color = *nearest;
    color_.erase(color_.begin(), nearest + 1);
    return Join(std::move(depth), color);
  }
  return std::nullopt;
}

}  // namespace palpate::capture
