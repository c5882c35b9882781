// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/udp_socket.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include "libs/core/error.hpp"

namespace palpate::gige_vision {
namespace {

constexpr std::size_t kMaxDatagram = 9216;  // a jumbo frame; commands are far smaller

std::string Cause() { return std::strerror(errno); }

sockaddr_in ToSocketAddress(std::uint32_t address, std::uint16_t port) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(address);
  to.sin_port = htons(port);
  return to;
}

std::uint32_t AddressOf(const sockaddr* address) {
  sockaddr_in ip{};
  std::memcpy(&ip, address, sizeof ip);
  return ntohl(ip.sin_addr.s_addr);
}

bool IsLoopback(std::uint32_t address) { return (address >> 24) == 127; }

}  // namespace

std::string ToText(std::uint32_t address) {
  const in_addr ip{htonl(address)};
  std::array<char, INET_ADDRSTRLEN> text{};
  return inet_ntop(AF_INET, &ip, text.data(), text.size());
}

Interface FindInterface(const std::string& address) {
  in_addr ip{};
  if (inet_pton(AF_INET, address.c_str(), &ip) != 1) {
    throw InputError("\"" + address + "\" is no IPv4 address (as 192.168.1.10)");
  }
  Interface found{ntohl(ip.s_addr), 0, 0};
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) throw RunError("cannot list the network interfaces: " + Cause());
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, &freeifaddrs);
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    // All of 127.0.0.0/8 is the loopback interface's, though it names only 127.0.0.1.
    const bool same = AddressOf(each->ifa_addr) == found.address;
    const bool loopback = (each->ifa_flags & IFF_LOOPBACK) != 0 && IsLoopback(found.address);
    if (!same && !loopback) continue;
    found.mask = each->ifa_netmask != nullptr ? AddressOf(each->ifa_netmask) : 0xffff'ffff;
    found.index = static_cast<int>(if_nametoindex(each->ifa_name));
    return found;
  }
  throw RunError("no network interface of this machine has the address " + address);
}

UdpSocket::UdpSocket(std::uint32_t address, std::uint16_t port, bool shared) {
  descriptor_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor_ < 0) throw RunError("cannot make a UDP socket: " + Cause());
  const int on = 1;
  if (shared) setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  setsockopt(descriptor_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  setsockopt(descriptor_, IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
  const sockaddr_in here = ToSocketAddress(address, port);
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0) {
    const std::string cause = Cause();
    close(descriptor_);
    throw RunError("cannot take UDP port " + std::to_string(port) + " of " + ToText(address) +
                   ": " + cause);
  }
}

UdpSocket::~UdpSocket() { close(descriptor_); }

std::uint16_t UdpSocket::port() const {
  sockaddr_in here{};
  socklen_t size = sizeof here;
  if (getsockname(descriptor_, reinterpret_cast<sockaddr*>(&here), &size) != 0) return 0;
  return ntohs(here.sin_port);
}

void UdpSocket::Send(ByteView packet, const Peer& to) const {
  const sockaddr_in there = ToSocketAddress(to.address, to.port);
  (void)sendto(descriptor_, packet.data(), packet.size(), MSG_DONTWAIT,
               reinterpret_cast<const sockaddr*>(&there), sizeof there);
}

std::optional<UdpSocket::Received> UdpSocket::Receive() const {
  Received received;
  received.packet.resize(kMaxDatagram);
  sockaddr_in from{};
  iovec piece{received.packet.data(), received.packet.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> ancillary{};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof from;
  message.msg_iov = &piece;
  message.msg_iovlen = 1;
  message.msg_control = ancillary.data();
  message.msg_controllen = ancillary.size();
  const ssize_t size = recvmsg(descriptor_, &message, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  received.packet.resize(static_cast<std::size_t>(size));
  received.from = {ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)};
  for (cmsghdr* each = CMSG_FIRSTHDR(&message); each != nullptr;
       each = CMSG_NXTHDR(&message, each)) {
    if (each->cmsg_level != IPPROTO_IP || each->cmsg_type != IP_PKTINFO) continue;
    in_pktinfo info{};
    std::memcpy(&info, CMSG_DATA(each), sizeof info);
    received.interface_index = info.ipi_ifindex;
  }
  return received;
}

}  // namespace palpate::gige_vision
