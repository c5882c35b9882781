// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/node/udp_receiver.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::motion_capture {

namespace {

constexpr std::size_t kLargestDatagram = 65536;
constexpr int kStopCheck_ms = 100;

in_addr AddressOf(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) == 1) return address;
  throw InputError("'" + text + "' is no IPv4 address");
}

[[noreturn]] void Fail(int socket, const std::string& what) {
  const std::string reason = std::strerror(errno);
  close(socket);
  throw RunError(what + ": " + reason);
}

int Open(const in_addr& interface, const in_addr* group, int port) {
  const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (handle < 0) throw RunError(std::string("cannot open a socket: ") + std::strerror(errno));
  const int yes = 1;
  setsockopt(handle, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  // Bound to the interface's address a socket would get no multicast.
  address.sin_addr.s_addr = group != nullptr ? htonl(INADDR_ANY) : interface.s_addr;
  if (bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    Fail(handle, "cannot listen on UDP port " + std::to_string(port));
  }
  if (group == nullptr) return handle;
  const ip_mreq membership{*group, interface};
  if (setsockopt(handle, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) != 0) {
    Fail(handle, "cannot join the multicast group (interface_address)");
  }
  return handle;
}

int Open(const std::string& interface_address, const std::string& group, int port) {
  const in_addr interface = AddressOf(interface_address);
  if (group.empty()) return Open(interface, nullptr, port);
  const in_addr group_address = AddressOf(group);
  return Open(interface, &group_address, port);
}

}  // namespace

UdpReceiver::UdpReceiver(const std::string& interface_address, const std::string& group, int port,
                         OnDatagram on_datagram)
    : socket_(Open(interface_address, group, port)),
      on_datagram_(std::move(on_datagram)),
      thread_([this] { Receive(); }) {}

UdpReceiver::~UdpReceiver() {
  stop_ = true;
  thread_.join();
  close(socket_);
}

void UdpReceiver::Receive() {
  std::vector<std::uint8_t> buffer(kLargestDatagram);
  while (!stop_) {
    pollfd waiting{socket_, POLLIN, 0};
    if (poll(&waiting, 1, kStopCheck_ms) <= 0) continue;
    const ssize_t size = recv(socket_, buffer.data(), buffer.size(), 0);
    if (size > 0) on_datagram_({buffer.begin(), buffer.begin() + size});
  }
}

}  // namespace palpate::motion_capture
