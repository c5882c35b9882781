// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/network/packet_size.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "libs/gige_vision/protocol.hpp"

namespace palpate::capture {

namespace {

constexpr int kGreatestPacketSize_bytes = 16404;  ///< where the camera names no limit

/// The IPv4 part of an address that the C library gives as a family of structs.
std::string TextOf(const sockaddr* address) {
  sockaddr_in inet;
  std::memcpy(&inet, address, sizeof(inet));
  char text[INET_ADDRSTRLEN] = {};
  inet_ntop(AF_INET, &inet.sin_addr, text, sizeof(text));
  return text;
}

}  // namespace

bool IsIpv4Address(const std::string& text) {
  in_addr parsed;
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
}

int ChoosePacketSize_bytes(int wanted_bytes, std::optional<int> mtu_bytes,
                           std::optional<std::pair<std::int64_t, std::int64_t>> camera_range) {
  std::int64_t size = wanted_bytes > 0 ? wanted_bytes : kGreatestPacketSize_bytes;
  size = std::min<std::int64_t>(size, mtu_bytes.value_or(kSafePacketSize_bytes));
  // A range that holds no sound size is a description's mistake, not a limit.
  if (camera_range && camera_range->second >= kLeastPacketSize_bytes) {
    size = std::min(size, camera_range->second);
  }
  if (camera_range && camera_range->first > 0 && camera_range->first <= kSafePacketSize_bytes) {
    size = std::max(size, camera_range->first);
  }
  return static_cast<int>(std::max<std::int64_t>(size, kLeastPacketSize_bytes)) & ~3;
}

std::optional<std::string> LocalAddressTowards(const std::string& address) {
  sockaddr_in target = {};
  target.sin_family = AF_INET;
  target.sin_port = htons(gige_vision::kControlPort);
  if (inet_pton(AF_INET, address.c_str(), &target.sin_addr) != 1) return std::nullopt;
  const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (handle < 0) return std::nullopt;
  sockaddr own = {};
  socklen_t size = sizeof(own);
  sockaddr generic;
  std::memcpy(&generic, &target, sizeof(generic));
  const bool known =
      connect(handle, &generic, sizeof(generic)) == 0 && getsockname(handle, &own, &size) == 0;
  close(handle);
  return known ? std::optional(TextOf(&own)) : std::nullopt;
}

std::optional<int> InterfaceMtu_bytes(const std::string& local_address) {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return std::nullopt;
  std::string name;
  for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    if (TextOf(entry->ifa_addr) == local_address) name = entry->ifa_name;
  }
  freeifaddrs(first);
  if (name.empty() || name.size() >= IFNAMSIZ) return std::nullopt;
  const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (handle < 0) return std::nullopt;
  ifreq request = {};
  std::memcpy(request.ifr_name, name.c_str(), name.size() + 1);
  const bool known = ioctl(handle, SIOCGIFMTU, &request) == 0;
  close(handle);
  return known ? std::optional(request.ifr_mtu) : std::nullopt;
}

}  // namespace palpate::capture
