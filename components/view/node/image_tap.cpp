// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/image_tap.hpp"

#include <utility>

#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::view {

ImageTap::ImageTap(const dds::Participant& participant, std::string_view topic, double max_rate_hz,
                   std::function<void()> on_image)
    : participant_(participant), limit_(max_rate_hz), on_image_(std::move(on_image)) {
  const dds::TopicSettings& settings = participant.table().At(topic);
  topic_ = {.dds_topic = dds::DdsTopicName(participant.ResolvedName(topic)),
            .dds_type = dds::DdsTypeName(settings.type),
            .reliability = dds::Reliability::kBestEffort,
            .durability = dds::Durability::kVolatile,
            .this_host_only = settings.this_host_only};
}

void ImageTap::Keep(dds::RawMessage message) {
  if (!limit_.Pass(MonotonicNow_ns())) return;
  {
    const std::lock_guard lock(mutex_);
    kept_ = std::move(message);
  }
  on_image_();
}

std::optional<dds::RawMessage> ImageTap::TakeRaw(bool wanted) {
  if (!wanted) {
    reader_.reset();
    kept_.reset();
    return std::nullopt;
  }
  if (!reader_ && !refused_) {
    try {
      reader_ = std::make_unique<dds::RawReader>(
          participant_.handle(), topic_,
          [this](dds::RawMessage message) { Keep(std::move(message)); });
    } catch (const RunError& error) {
      refused_ = true;
      participant_.WriteLog(Severity::kWarning, error.what());
    }
  }
  std::optional<dds::RawMessage> raw;
  {
    const std::lock_guard lock(mutex_);
    raw.swap(kept_);
  }
  return raw;
}

}  // namespace palpate::view
