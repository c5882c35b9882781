// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/foxglove_hub.hpp"

#include <algorithm>
#include <optional>
#include <variant>

#include "libs/core/clock.hpp"

namespace palpate::view {

namespace {

/// Of one client.
constexpr std::size_t kMostSubscriptions = 1000;
/// Larger messages are not queued: of a slow client's images only the newest waits.
constexpr std::size_t kLargeBytes = 64 * 1024;

}  // namespace

FoxgloveHub::FoxgloveHub(std::string name, std::string version, WebServer* server,
                         OnWanted on_wanted)
    : name_(std::move(name)),
      version_(std::move(version)),
      session_(std::to_string(WallNow_ns())),
      server_(server),
      on_wanted_(std::move(on_wanted)) {}

HttpAnswer FoxgloveHub::Get(std::string_view) {
  return {.status = 200,
          .body = std::make_shared<const std::string>(
              "This port speaks the WebSocket protocol of Foxglove: open a connection to it in "
              "Foxglove or Lichtblick.\n")};
}

void FoxgloveHub::Opened(ClientId client) {
  clients_[client];
  client_count_ = static_cast<int>(clients_.size());
  server_->Send(client, TextMessage("serverInfo", foxglove::ServerInfoText(
                                                      name_, session_, {{"palpate", version_}})));
  std::vector<foxglove::Channel> channels;
  for (const auto& [id, open] : channels_) channels.push_back(open.channel);
  server_->Send(client, TextMessage("advertise", foxglove::AdvertiseText(channels)));
}

void FoxgloveHub::Closed(ClientId client) {
  End([client](const Subscriber& subscriber) { return subscriber.first == client; });
  clients_.erase(client);
  client_count_ = static_cast<int>(clients_.size());
}

void FoxgloveHub::Received(ClientId client, std::string_view bytes, bool binary) {
  if (binary) {
    return SendStatus(client, foxglove::StatusLevel::kError,
                      "this server takes no binary messages");
  }
  const auto request = foxglove::ParseRequest(bytes, kMostSubscriptions);
  if (const auto* subscribe = std::get_if<foxglove::Subscribe>(&request)) {
    Subscribe(client, *subscribe);
  } else if (const auto* unsubscribe = std::get_if<foxglove::Unsubscribe>(&request)) {
    Unsubscribe(client, *unsubscribe);
  } else {
    SendStatus(client, foxglove::StatusLevel::kWarning,
               std::get<foxglove::NotServed>(request).reason);
  }
}

void FoxgloveHub::SendStatus(ClientId client, foxglove::StatusLevel level,
                             const std::string& text) {
  server_->Send(client, TextMessage("status", foxglove::StatusText(level, text)));
}

void FoxgloveHub::Send(const Open& open, const Subscriber& to, const Kept& message) {
  const bool latest = message.bytes.bytes.size() > kLargeBytes || open.channel.id == kSceneChannel;
  server_->Send(to.first, {.kind = open.channel.topic,
                           .delivery = latest ? Delivery::kLatest : Delivery::kQueued,
                           .binary = true,
                           .head = std::make_shared<const std::string>(
                               foxglove::MessageDataHead(to.second, message.time_ns)),
                           .body = message.bytes.bytes,
                           .body_owner = message.bytes.owner});
}

void FoxgloveHub::TellWanted(Open* open, bool wanted) {
  if (open->channel.id == kSceneChannel) scene_ = wanted;
  if (!wanted) open->kept.clear();
  on_wanted_(open->channel.id, wanted);
}

void FoxgloveHub::Subscribe(ClientId client, const foxglove::Subscribe& request) {
  auto& own = clients_.at(client);
  for (const auto& [subscription, channel] : request.subscriptions) {
    const auto found = channels_.find(channel);
    if (found == channels_.end() || own.contains(subscription) ||
        own.size() >= kMostSubscriptions) {
      SendStatus(client, foxglove::StatusLevel::kError,
                 "subscription " + std::to_string(subscription) + " to channel " +
                     std::to_string(channel) +
                     ": no such channel, the same number twice, or too many");
      continue;
    }
    own[subscription] = channel;
    Open& open = found->second;
    open.subscribers.emplace_back(client, subscription);
    for (const Kept& message : open.kept) Send(open, open.subscribers.back(), message);
    if (open.subscribers.size() == 1) TellWanted(&open, true);
  }
}

void FoxgloveHub::Unsubscribe(ClientId client, const foxglove::Unsubscribe& request) {
  for (const foxglove::SubscriptionId subscription : request.subscriptions) {
    if (clients_.at(client).erase(subscription) == 0) {
      SendStatus(client, foxglove::StatusLevel::kWarning,
                 "there is no subscription " + std::to_string(subscription));
    }
    End([&](const Subscriber& subscriber) {
      return subscriber == Subscriber(client, subscription);
    });
  }
}

void FoxgloveHub::End(const std::function<bool(const Subscriber&)>& ends) {
  for (auto& [id, open] : channels_) {
    if (std::erase_if(open.subscribers, ends) > 0 && open.subscribers.empty()) {
      TellWanted(&open, false);
    }
  }
}

void FoxgloveHub::AddChannel(foxglove::Channel channel, std::size_t kept) {
  server_->Post([this, channel = std::move(channel), kept] {
    channels_[channel.id] = {.channel = channel, .kept_count = kept, .kept = {}, .subscribers = {}};
    for (const auto& [client, subscriptions] : clients_) {
      server_->Send(client, TextMessage("advertise", foxglove::AdvertiseText({channel})));
    }
  });
}

void FoxgloveHub::RemoveChannel(foxglove::ChannelId channel) {
  server_->Post([this, channel] {
    if (channels_.erase(channel) == 0) return;
    for (auto& [client, subscriptions] : clients_) {
      std::erase_if(subscriptions, [&](const auto& one) { return one.second == channel; });
      server_->Send(client, TextMessage("unadvertise", foxglove::UnadvertiseText({channel})));
    }
  });
}

void FoxgloveHub::Publish(foxglove::ChannelId channel, std::int64_t time_ns, Bytes bytes) {
  server_->Post([this, channel, message = Kept{time_ns, std::move(bytes)}] {
    const auto found = channels_.find(channel);
    if (found == channels_.end()) return;
    Open& open = found->second;
    for (const Subscriber& subscriber : open.subscribers) Send(open, subscriber, message);
    if (open.kept_count == 0) return;
    open.kept.push_back(message);
    if (open.kept.size() > open.kept_count) open.kept.pop_front();
  });
}

void FoxgloveHub::TellStatus(foxglove::StatusLevel level, std::string text) {
  server_->Post([this, level, text = std::move(text)] {
    for (const auto& [client, subscriptions] : clients_) SendStatus(client, level, text);
  });
}

}  // namespace palpate::view
