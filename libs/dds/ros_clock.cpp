// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/ros_clock.hpp"

#include "libs/dds/stamp.hpp"

namespace palpate::dds {

RosClock::RosClock(dds_entity_t participant, const TopicSettings& topic,
                   const std::string& ros_name) {
  reader_.emplace(participant, topic, ros_name, std::function<void()>());
}

std::int64_t RosClock::Now_ns() {
  if (!reader_) return WallClockNs();
  const std::lock_guard lock(mutex_);
  for (const auto& message : reader_->Take()) last_ns_ = StampNs(message.clock);
  return last_ns_;
}

}  // namespace palpate::dds
