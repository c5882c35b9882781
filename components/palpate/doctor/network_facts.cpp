// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include "components/palpate/doctor/machine_facts.hpp"

namespace palpate::command {

namespace {

/// A UDP socket, closed at the end.
class Socket {
 public:
  Socket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

const sockaddr* Generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

/// 0.0.0.0 where the name cannot be resolved.
sockaddr_in Resolve(const std::string& name, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(name.c_str(), nullptr, &hints, &found) != 0) return address;
  sockaddr_in resolved{};
  std::memcpy(&resolved, found->ai_addr, sizeof(resolved));
  address.sin_addr = resolved.sin_addr;
  freeaddrinfo(found);
  return address;
}

bool LocalPort(int descriptor, sockaddr_in* address) {
  socklen_t size = sizeof(*address);
  return getsockname(descriptor, reinterpret_cast<sockaddr*>(address), &size) == 0;
}

/// Joins the group of RTPS's discovery (2.3, section 9.6.1.4.1) on a port of its own.
bool JoinGroup(int descriptor, const in_addr& local, sockaddr_in* group) {
  sockaddr_in any{};
  any.sin_family = AF_INET;
  if (bind(descriptor, Generic(any), sizeof(any)) != 0) return false;
  if (!LocalPort(descriptor, group)) return false;
  inet_pton(AF_INET, "239.255.0.1", &group->sin_addr);
  const ip_mreq membership{.imr_multiaddr = group->sin_addr, .imr_interface = local};
  const unsigned char on = 1;
  return setsockopt(descriptor, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) ==
             0 &&
         setsockopt(descriptor, IPPROTO_IP, IP_MULTICAST_IF, &local, sizeof(local)) == 0 &&
         setsockopt(descriptor, IPPROTO_IP, IP_MULTICAST_LOOP, &on, sizeof(on)) == 0;
}

/// Local ports of all UDP sockets of this host.
std::set<int> UdpPorts() {
  std::set<int> ports;
  for (const char* file : {"/proc/net/udp", "/proc/net/udp6"}) {
    std::ifstream table(file);
    std::string line;
    std::getline(table, line);  // the head
    while (std::getline(table, line)) {
      std::istringstream words(line);
      std::string number;
      std::string local;  // "0100007F:1CF2"
      words >> number >> local;
      const auto colon = local.find(':');
      constexpr int kHex = 16;
      if (colon != local.npos) ports.insert(std::stoi(local.substr(colon + 1), nullptr, kHex));
    }
  }
  return ports;
}

}  // namespace

std::string LocalAddressTo(const std::string& address) {
  constexpr std::uint16_t kAnyPort = 7400;
  const sockaddr_in there = Resolve(address, kAnyPort);
  const Socket socket;
  if (there.sin_addr.s_addr == INADDR_ANY) return {};
  if (connect(socket.descriptor(), Generic(there), sizeof(there)) != 0) return {};
  sockaddr_in here{};
  if (!LocalPort(socket.descriptor(), &here)) return {};
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &here.sin_addr, text.data(), text.size());
  return text.data();
}

bool MulticastComesBack(const std::string& local_address, std::chrono::milliseconds wait) {
  in_addr local{};
  if (inet_pton(AF_INET, local_address.c_str(), &local) != 1) return false;
  const Socket socket;
  sockaddr_in group{};
  if (!JoinGroup(socket.descriptor(), local, &group)) return false;
  constexpr std::array<char, 8> kProbe{'p', 'a', 'l', 'p', 'a', 't', 'e', '?'};
  const auto sent =
      sendto(socket.descriptor(), kProbe.data(), kProbe.size(), 0, Generic(group), sizeof(group));
  if (sent != static_cast<ssize_t>(kProbe.size())) return false;
  pollfd ready{.fd = socket.descriptor(), .events = POLLIN, .revents = 0};
  return poll(&ready, 1, static_cast<int>(wait.count())) == 1;
}

int CountUsedIndices(int domain_id, int limit) {
  // RTPS 2.3, section 9.6.1.1: the unicast ports of participant i are these and the next.
  constexpr int kBase = 7400;
  constexpr int kPerDomain = 250;
  constexpr int kUnicast = 10;
  const int first = kBase + kPerDomain * domain_id + kUnicast;
  const std::set<int> ports = UdpPorts();
  int used = 0;
  for (int index = 0; index <= limit; ++index) {
    const int port = first + 2 * index;
    used += ports.contains(port) || ports.contains(port + 1) ? 1 : 0;
  }
  return used;
}

}  // namespace palpate::command
