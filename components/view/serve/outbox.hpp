// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "components/view/serve/out_message.hpp"

namespace palpate::view {

/// What one client has been sent.
struct ClientCounts {
  std::uint64_t sent = 0;
  std::map<std::string, std::uint64_t> dropped;  ///< by kind
  std::size_t queue_bytes = 0;                   ///< waiting now
};

/// What waits for one client. Queued messages go first; of the others only the newest of each kind
/// waits, in the place of the older one. What is dropped is counted.
class Outbox {
 public:
  struct Limits {
    std::size_t queued = 200;  ///< messages
    std::size_t queued_bytes = 16 * 1024 * 1024;
  };

  Outbox() = default;
  explicit Outbox(const Limits& limits) : limits_(limits) {}

  void Push(OutMessage message);
  /// The message that is to be sent next; nullopt: none waits.
  std::optional<OutMessage> Pop();

  bool empty() const { return queued_.empty() && latest_.empty(); }
  const ClientCounts& counts() const { return counts_; }

 private:
  void DropOldest();

  Limits limits_;
  std::deque<OutMessage> queued_;
  std::deque<OutMessage> latest_;  ///< one of each kind
  std::size_t queued_bytes_ = 0;
  ClientCounts counts_;
};

}  // namespace palpate::view
