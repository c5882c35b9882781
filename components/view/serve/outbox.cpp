// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/outbox.hpp"

#include <algorithm>
#include <utility>

namespace palpate::view {

void Outbox::DropOldest() {
  const OutMessage& oldest = queued_.front();
  ++counts_.dropped[oldest.kind];
  queued_bytes_ -= oldest.size();
  counts_.queue_bytes -= oldest.size();
  queued_.pop_front();
}

void Outbox::Push(OutMessage message) {
  const std::size_t size = message.size();
  counts_.queue_bytes += size;
  if (message.delivery == Delivery::kQueued) {
    queued_bytes_ += size;
    queued_.push_back(std::move(message));
    while (queued_.size() > 1 &&
           (queued_.size() > limits_.queued || queued_bytes_ > limits_.queued_bytes)) {
      DropOldest();
    }
    return;
  }
  const auto older = std::find_if(latest_.begin(), latest_.end(), [&](const OutMessage& waiting) {
    return waiting.kind == message.kind;
  });
  if (older == latest_.end()) {
    latest_.push_back(std::move(message));
    return;
  }
  ++counts_.dropped[message.kind];
  counts_.queue_bytes -= older->size();
  *older = std::move(message);
}

std::optional<OutMessage> Outbox::Pop() {
  if (empty()) return std::nullopt;
  std::deque<OutMessage>& from = queued_.empty() ? latest_ : queued_;
  OutMessage message = std::move(from.front());
  from.pop_front();
  counts_.queue_bytes -= message.size();
  if (message.delivery == Delivery::kQueued) queued_bytes_ -= message.size();
  ++counts_.sent;
  return message;
}

}  // namespace palpate::view
