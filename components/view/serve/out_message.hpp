// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace palpate::view {

/// How a message waits for a client that is slow.
enum class Delivery {
  kQueued,  ///< behind the others of this sort; where too many wait, the oldest goes
  kLatest,  ///< only the newest of its kind waits
};

/// One message of a WebSocket, made once and shared by all clients: `head`, then `body`.
struct OutMessage {
  std::string kind;  ///< what is counted, and what overtakes: "mesh_state"
  Delivery delivery = Delivery::kQueued;
  bool binary = false;
  std::shared_ptr<const std::string> head;
  std::string_view body = {};  ///< may be empty
  std::shared_ptr<const void> body_owner = {};

  std::size_t size() const { return head->size() + body.size(); }
};

inline OutMessage TextMessage(std::string kind, std::string text,
                              Delivery delivery = Delivery::kQueued) {
  return {.kind = std::move(kind),
          .delivery = delivery,
          .head = std::make_shared<const std::string>(std::move(text))};
}

inline OutMessage BinaryMessage(std::string kind, std::string bytes,
                                Delivery delivery = Delivery::kLatest) {
  return {.kind = std::move(kind),
          .delivery = delivery,
          .binary = true,
          .head = std::make_shared<const std::string>(std::move(bytes))};
}

}  // namespace palpate::view
