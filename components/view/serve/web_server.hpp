// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/view/serve/access.hpp"
#include "components/view/serve/outbox.hpp"

namespace palpate::view {

using ClientId = std::uint64_t;  ///< of one WebSocket; unique in a server

/// The answer to a GET.
struct HttpAnswer {
  int status = 404;
  std::string content_type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = {};
  bool gzip = false;      ///< how `body` is packed; whoever takes no gzip is refused
  std::string etag = {};  ///< with the quotes; empty: not to be kept
};

/// What a port does for its clients. All calls come from the server's thread.
class WebEndpoint {
 public:
  virtual ~WebEndpoint() = default;

  /// `path` begins with "/" and has no query.
  virtual HttpAnswer Get(std::string_view path) = 0;
  /// Whether this path becomes a WebSocket.
  virtual bool IsSocket(std::string_view path) const = 0;
  /// One of `offered`, or empty for none; nullopt: the client is refused.
  virtual std::optional<std::string> Subprotocol(const std::vector<std::string>& offered) const = 0;
  virtual void Opened(ClientId client) = 0;
  virtual void Received(ClientId client, std::string_view bytes, bool binary) = 0;
  virtual void Closed(ClientId client) = 0;
};

/// Where a port listens, and what it bears.
struct PortSettings {
  std::string address = "127.0.0.1";
  int port = 0;          ///< 0: any free one
  int further = 0;       ///< so many following ports are tried where this one is in use
  AccessRules rules;     ///< the address and the names of this machine are added to `hosts`
  int max_clients = 16;  ///< WebSockets
  std::size_t max_message_bytes = 64 * 1024;     ///< of a client; a longer one ends the connection
  std::chrono::milliseconds header_time{10000};  ///< for a request to be complete
  std::chrono::milliseconds idle_time{60000};    ///< without a sign of life of a client
  Outbox::Limits outbox = {};
};

/// HTTP and WebSocket on any number of ports, in one thread of its own. Reads GET and HEAD without
/// a body. The endpoints must outlive this.
class WebServer {
 public:
  WebServer();
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Before Start(). Returns the port. Throws RunError where the address cannot be bound.
  int Listen(const PortSettings& settings, WebEndpoint* endpoint);
  void Start();

  /// Runs `work` in the server's thread. From any thread.
  void Post(std::function<void()> work);
  /// Before Start(): runs `work` again and again in the server's thread.
  void Every(std::chrono::milliseconds period, std::function<void()> work);

  // From the server's thread only. An unknown client is passed over: it has gone.
  void Send(ClientId client, const OutMessage& message);
  /// Sends what is queued, then closes the connection. `code`: of RFC 6455, 1008 for a refusal.
  void Close(ClientId client, std::uint16_t code, const std::string& reason);
  ClientCounts CountsOf(ClientId client) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::view
