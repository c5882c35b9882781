// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/view/client/web_client.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace palpate::view {

namespace {

using Clock = std::chrono::steady_clock;

std::chrono::milliseconds Until(Clock::time_point end) {
  return std::max(std::chrono::milliseconds(0),
                  std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()));
}

std::size_t ContentLength(std::string_view head) {
  constexpr std::string_view kName = "Content-Length: ";
  const std::size_t at = head.find(kName);
  std::size_t length = 0;
  if (at != head.npos) {
    const char* begin = head.data() + at + kName.size();
    std::from_chars(begin, head.data() + head.size(), length);
  }
  return length;
}

}  // namespace

WebClient::WebClient(int port) : port_(port), socket_(socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
}

WebClient::~WebClient() {
  if (socket_ >= 0) close(socket_);
}

WebClient::WebClient(WebClient&& other) noexcept
    : port_(other.port_),
      socket_(std::exchange(other.socket_, -1)),
      received_(std::move(other.received_)),
      ended_(other.ended_) {}

bool WebClient::Send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool WebClient::Fill(std::chrono::milliseconds limit) {
  pollfd wanted{socket_, POLLIN, 0};
  if (ended_ || poll(&wanted, 1, static_cast<int>(limit.count())) <= 0) return false;
  std::array<char, 65536> bytes;
  const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
  ended_ = count <= 0;
  if (!ended_) received_.append(bytes.data(), static_cast<std::size_t>(count));
  return !ended_;
}

bool WebClient::FillTo(std::size_t size, Clock::time_point end) {
  while (received_.size() < size) {
    if (!Fill(Until(end))) return false;
  }
  return true;
}

std::string WebClient::ReadToEnd(std::chrono::milliseconds limit) {
  const auto end = Clock::now() + limit;
  while (Fill(Until(end))) {
  }
  return std::exchange(received_, {});
}

bool WebClient::AwaitEnd(std::chrono::milliseconds limit) {
  ReadToEnd(limit);
  return ended_;
}

std::string WebClient::ReadResponse() {
  const auto end = Clock::now() + std::chrono::seconds(10);
  std::size_t head = 0;
  while ((head = received_.find("\r\n\r\n")) == received_.npos) {
    if (!Fill(Until(end))) return std::exchange(received_, {});
  }
  const std::size_t whole = head + 4 + ContentLength(received_.substr(0, head));
  FillTo(whole, end);
  std::string response = received_.substr(0, whole);
  received_.erase(0, whole);
  return response;
}

std::string WebClient::Upgrade(const std::string& path, const std::string& headers) {
  Send(GetRequest(path,
                  "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                      headers));
  return ReadResponse();
}

std::optional<WebClient::Frame> WebClient::ReadFrame(std::chrono::milliseconds limit) {
  const auto end = Clock::now() + limit;
  const auto byte = [this](std::size_t i) {
    return static_cast<std::uint64_t>(static_cast<unsigned char>(received_[i]));
  };
  while (true) {
    if (!FillTo(2, end)) return std::nullopt;
    const std::size_t extra = byte(1) == 126 ? 2 : byte(1) == 127 ? 8 : 0;
    if (!FillTo(2 + extra, end)) return std::nullopt;
    std::uint64_t size = extra == 0 ? byte(1) : 0;
    for (std::size_t i = 0; i < extra; ++i) size = size << 8 | byte(2 + i);
    if (!FillTo(2 + extra + size, end)) return std::nullopt;
    Frame frame{static_cast<int>(byte(0) & 0x0F), received_.substr(2 + extra, size)};
    received_.erase(0, 2 + extra + size);
    constexpr int kPing = 9;
    if (frame.opcode != kPing) return frame;
    SendFrame(10, frame.payload);
  }
}

bool WebClient::SendFrame(int opcode, std::string_view payload) {
  std::string bytes(1, static_cast<char>(0x80 | opcode));
  if (payload.size() < 126) {
    bytes += static_cast<char>(0x80 | payload.size());
  } else {
    const bool is_short = payload.size() < 65536;
    bytes += static_cast<char>(0x80 | (is_short ? 126 : 127));
    for (int shift = is_short ? 8 : 56; shift >= 0; shift -= 8) {
      bytes += static_cast<char>(payload.size() >> shift & 0xFF);
    }
  }
  constexpr std::string_view kMask = "mask";
  bytes += kMask;
  for (std::size_t i = 0; i < payload.size(); ++i) {
    bytes += static_cast<char>(payload[i] ^ kMask[i % kMask.size()]);
  }
  return Send(bytes);
}

std::string GetRequest(const std::string& path, const std::string& headers,
                       const std::string& host) {
  return "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n" + headers + "\r\n";
}

std::string Fetch(int port, const std::string& path, const std::string& headers,
                  const std::string& host) {
  WebClient client(port);
  client.Send(GetRequest(path, headers, host));
  return client.ReadResponse();
}

}  // namespace palpate::view
