// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace palpate::view::foxglove {

// The WebSocket protocol of Foxglove and Lichtblick, version 1, as far as a server needs it that
// only sends: github.com/foxglove/ws-protocol.

using ChannelId = std::uint32_t;
using SubscriptionId = std::uint32_t;

/// Names of the protocol that clients offer.
inline constexpr const char* kSubprotocols[] = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

/// The first of ours that is offered; nullopt: none.
std::optional<std::string> ChooseSubprotocol(const std::vector<std::string>& offered);

struct Channel {
  ChannelId id = 0;
  std::string topic;
  std::string encoding;     ///< of messages: "cdr", "json"
  std::string schema_name;  ///< "palpate_msgs/msg/ForceArray"
  std::string schema;
  std::string schema_encoding;  ///< "ros2msg", "jsonschema"
};

enum class StatusLevel { kInfo = 0, kWarning = 1, kError = 2 };

/// `session`: another one tells clients that all channels are new.
std::string ServerInfoText(const std::string& name, const std::string& session,
                           const std::map<std::string, std::string>& metadata);
std::string AdvertiseText(const std::vector<Channel>& channels);
std::string UnadvertiseText(const std::vector<ChannelId>& channels);
std::string StatusText(StatusLevel level, const std::string& message);

/// What goes in front of the bytes of a message.
std::string MessageDataHead(SubscriptionId subscription, std::int64_t time_ns);

struct Subscribe {
  std::vector<std::pair<SubscriptionId, ChannelId>> subscriptions;
};
struct Unsubscribe {
  std::vector<SubscriptionId> subscriptions;
};
/// A request that this server does not serve, or that is none.
struct NotServed {
  std::string reason;
};
using ClientRequest = std::variant<NotServed, Subscribe, Unsubscribe>;

/// Reads a text of a client; at most `most` subscriptions of one request are taken.
ClientRequest ParseRequest(std::string_view text, std::size_t most);

}  // namespace palpate::view::foxglove
