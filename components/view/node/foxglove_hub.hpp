// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "components/view/foxglove/protocol.hpp"
#include "components/view/serve/web_server.hpp"

namespace palpate::view {

/// The clients of the Foxglove port and the channels that they see. The functions below Every...
/// may be called from any thread.
class FoxgloveHub : public WebEndpoint {
 public:
  /// Told, from the server's thread, when a channel gets its first subscriber and when it has lost
  /// its last one.
  using OnWanted = std::function<void(foxglove::ChannelId, bool wanted)>;

  /// `server` must outlive this's last call.
  FoxgloveHub(std::string name, std::string version, WebServer* server, OnWanted on_wanted);

  /// One message of a channel: `head` with the bytes, or `body` with their owner.
  struct Bytes {
    std::shared_ptr<const void> owner;
    std::string_view bytes;
  };

  /// `kept`: so many messages are kept for those who subscribe later, while somebody subscribes.
  void AddChannel(foxglove::Channel channel, std::size_t kept);
  void RemoveChannel(foxglove::ChannelId channel);
  void Publish(foxglove::ChannelId channel, std::int64_t time_ns, Bytes bytes);
  /// A line that clients show.
  void TellStatus(foxglove::StatusLevel level, std::string text);

  int clients() const { return client_count_; }
  /// Of a channel that was added first.
  bool IsWanted(foxglove::ChannelId channel) const { return channel == kSceneChannel && scene_; }

  /// Made by this program itself.
  static constexpr foxglove::ChannelId kSceneChannel = 1;

  HttpAnswer Get(std::string_view path) override;
  bool IsSocket(std::string_view) const override { return true; }
  std::optional<std::string> Subprotocol(const std::vector<std::string>& offered) const override {
    return foxglove::ChooseSubprotocol(offered);
  }
  void Opened(ClientId client) override;
  void Received(ClientId client, std::string_view bytes, bool binary) override;
  void Closed(ClientId client) override;

 private:
  using Subscriber = std::pair<ClientId, foxglove::SubscriptionId>;
  struct Kept {
    std::int64_t time_ns = 0;
    Bytes bytes;
  };
  struct Open {
    foxglove::Channel channel;
    std::size_t kept_count = 0;
    std::deque<Kept> kept;
    std::vector<Subscriber> subscribers;
  };

  void SendStatus(ClientId client, foxglove::StatusLevel level, const std::string& text);
  void Send(const Open& open, const Subscriber& to, const Kept& message);
  void Subscribe(ClientId client, const foxglove::Subscribe& request);
  void Unsubscribe(ClientId client, const foxglove::Unsubscribe& request);
  /// Takes away those subscriptions of which `ends` says so.
  void End(const std::function<bool(const Subscriber&)>& ends);
  void TellWanted(Open* open, bool wanted);

  std::string name_;
  std::string version_;
  std::string session_;
  WebServer* server_;
  OnWanted on_wanted_;
  // Of the server's thread:
  std::map<foxglove::ChannelId, Open> channels_;
  std::map<ClientId, std::map<foxglove::SubscriptionId, foxglove::ChannelId>> clients_;
  std::atomic<bool> scene_ = false;
  std::atomic<int> client_count_ = 0;
};

}  // namespace palpate::view
