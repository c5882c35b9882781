// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "components/view/frames/page_request.hpp"
#include "components/view/serve/message_budget.hpp"
#include "components/view/serve/web_server.hpp"

namespace palpate::view {

/// What the page is told first.
struct PageGreeting {
  std::string version;
  std::string source = "live";  ///< "live", "recording", "experiment" or "robot"
  std::string source_name;
  bool read_only = true;
  bool has_probe = true;
};

/// The clients of the page: each is sent what it wants, a new one first the last message of each
/// kind. Publish(), Reply() and SetSnapshot() may be called from any thread.
class PageHub : public WebEndpoint {
 public:
  using OnRequest = std::function<void(ClientId, PageRequest)>;

  /// `server` must outlive this's last call. `on_request` is called from the server's thread, for
  /// all requests but SubscribeRequest and BadRequest.
  PageHub(PageGreeting greeting, WebServer* server, OnRequest on_request);

  /// Once a second, before the server starts: tells each client what it was sent.
  void TellCounts();

  void Publish(OutMessage message);
  void Reply(ClientId client, OutMessage message);
  /// The answer to a request that may not be.
  void Refuse(ClientId client, const std::string& request, const std::string& reason);
  void SetSnapshot(std::string json);
  /// Forgets all messages: another place of the recording is shown.
  void Forget();

  int clients() const { return clients_wanting_[kAll]; }
  bool WantsImages() const { return clients_wanting_[kImages] > 0; }
  bool WantsClouds() const { return clients_wanting_[kClouds] > 0; }

  HttpAnswer Get(std::string_view path) override;
  bool IsSocket(std::string_view path) const override { return path == "/live"; }
  std::optional<std::string> Subprotocol(const std::vector<std::string>& offered) const override;
  void Opened(ClientId client) override;
  void Received(ClientId client, std::string_view bytes, bool binary) override;
  void Closed(ClientId client) override;

 private:
  enum Wanting { kAll, kImages, kClouds, kWantingCount };
  struct Client {
    SubscribeRequest wanted;
    MessageBudget budget;
    std::uint64_t sent_before = 0;
  };

  std::string HelloText() const;
  static bool IsWanted(const Client& client, const std::string& kind);
  void Count();
  void EndForBadRequest(ClientId client, const BadRequest& bad);

  PageGreeting greeting_;
  WebServer* server_;
  OnRequest on_request_;
  std::map<ClientId, Client> clients_;        ///< of the server's thread
  std::map<std::string, OutMessage> latest_;  ///< by kind; of the server's thread
  std::atomic<int> clients_wanting_[kWantingCount] = {};
  std::mutex mutex_;
  std::shared_ptr<const std::string> snapshot_;
};

}  // namespace palpate::view
