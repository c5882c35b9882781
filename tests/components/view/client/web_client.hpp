// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::view {

/// A TCP client that sends what it is told, so that it can break every rule of HTTP and WebSocket.
class WebClient {
 public:
  explicit WebClient(int port);
  ~WebClient();
  WebClient(WebClient&& other) noexcept;
  WebClient& operator=(WebClient&&) = delete;

  /// False where the server has closed the connection.
  bool Send(std::string_view bytes);
  /// Reads until the server closes the connection, or for `limit`. Empty: nothing came.
  std::string ReadToEnd(std::chrono::milliseconds limit = std::chrono::seconds(10));
  /// Whether the server closes the connection within `limit`; what comes before is thrown away.
  bool AwaitEnd(std::chrono::milliseconds limit = std::chrono::seconds(10));

  /// One response with its body.
  std::string ReadResponse();

  /// Asks for a WebSocket; the response up to its empty line. `headers`: further lines, each with
  /// its end.
  std::string Upgrade(const std::string& path, const std::string& headers = {});

  struct Frame {
    int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping
    std::string payload;
  };
  /// The next message, pings left out; nullopt: none came within `limit`, or the connection ended.
  std::optional<Frame> ReadFrame(std::chrono::milliseconds limit = std::chrono::seconds(10));
  /// One masked frame with FIN.
  bool SendFrame(int opcode, std::string_view payload);
  bool SendText(std::string_view text) { return SendFrame(1, text); }

  int port() const { return port_; }

 private:
  bool Fill(std::chrono::milliseconds limit);
  bool FillTo(std::size_t size, std::chrono::steady_clock::time_point end);

  int port_;
  int socket_ = -1;
  std::string received_;
  bool ended_ = false;
};

/// "GET /path HTTP/1.1" of a browser on this machine.
std::string GetRequest(const std::string& path, const std::string& headers = {},
                       const std::string& host = "localhost");

/// One request on a connection of its own: the whole response.
std::string Fetch(int port, const std::string& path, const std::string& headers = {},
                  const std::string& host = "localhost");

}  // namespace palpate::view
