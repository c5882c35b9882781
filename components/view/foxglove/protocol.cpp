// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/foxglove/protocol.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

namespace palpate::view::foxglove {

namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the protocol is little-endian");

std::string ToText(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::uint32_t> IdOf(const Json& json) {
  if (!json.is_number_unsigned()) return std::nullopt;
  const auto number = json.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

const Json& ListIn(const Json& request, const char* key) {
  static const Json kEmpty = Json::array();
  const auto list = request.find(key);
  return list != request.end() && list->is_array() ? *list : kEmpty;
}

ClientRequest ParseSubscribe(const Json& request, std::size_t most) {
  Subscribe subscribe;
  for (const Json& entry : ListIn(request, "subscriptions")) {
    if (!entry.is_object() || !entry.contains("id") || !entry.contains("channelId")) {
      return NotServed{"a subscription needs id and channelId"};
    }
    const auto id = IdOf(entry["id"]);
    const auto channel = IdOf(entry["channelId"]);
    if (!id || !channel) return NotServed{"id and channelId are numbers of 32 bits"};
    if (subscribe.subscriptions.size() == most) return NotServed{"too many subscriptions"};
    subscribe.subscriptions.emplace_back(*id, *channel);
  }
  return subscribe;
}

ClientRequest ParseUnsubscribe(const Json& request, std::size_t most) {
  Unsubscribe unsubscribe;
  for (const Json& entry : ListIn(request, "subscriptionIds")) {
    const auto id = IdOf(entry);
    if (!id) return NotServed{"subscriptionIds are numbers of 32 bits"};
    if (unsubscribe.subscriptions.size() == most) return NotServed{"too many subscriptions"};
    unsubscribe.subscriptions.push_back(*id);
  }
  return unsubscribe;
}

}  // namespace

std::optional<std::string> ChooseSubprotocol(const std::vector<std::string>& offered) {
  for (const std::string& one : offered) {
    if (std::find(std::begin(kSubprotocols), std::end(kSubprotocols), one) !=
        std::end(kSubprotocols)) {
      return one;
    }
  }
  return std::nullopt;
}

std::string ServerInfoText(const std::string& name, const std::string& session,
                           const std::map<std::string, std::string>& metadata) {
  return ToText({{"op", "serverInfo"},
                 {"name", name},
                 {"capabilities", Json::array()},
                 {"supportedEncodings", Json::array()},
                 {"metadata", metadata},
                 {"sessionId", session}});
}

std::string AdvertiseText(const std::vector<Channel>& channels) {
  Json list = Json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return ToText({{"op", "advertise"}, {"channels", list}});
}

std::string UnadvertiseText(const std::vector<ChannelId>& channels) {
  return ToText({{"op", "unadvertise"}, {"channelIds", channels}});
}

std::string StatusText(StatusLevel level, const std::string& message) {
  return ToText({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}});
}

std::string MessageDataHead(SubscriptionId subscription, std::int64_t time_ns) {
  constexpr char kMessageData = 1;
  std::array<char, 1 + sizeof(subscription) + sizeof(time_ns)> head{kMessageData};
  std::memcpy(head.data() + 1, &subscription, sizeof(subscription));
  std::memcpy(head.data() + 1 + sizeof(subscription), &time_ns, sizeof(time_ns));
  return {head.data(), head.size()};
}

ClientRequest ParseRequest(std::string_view text, std::size_t most) {
  const Json request = Json::parse(text, nullptr, false);
  if (!request.is_object() || !request.contains("op") || !request["op"].is_string()) {
    return NotServed{"a request is a JSON object with op"};
  }
  const auto op = request["op"].get<std::string>();
  if (op == "subscribe") return ParseSubscribe(request, most);
  if (op == "unsubscribe") return ParseUnsubscribe(request, most);
  return NotServed{"'" + op.substr(0, 40) + "' is not offered by this server"};
}

}  // namespace palpate::view::foxglove
