// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/network_interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <utility>

namespace palpate {

namespace {

std::string AddressText(const sockaddr& address) {
  sockaddr_in ipv4{};
  std::memcpy(&ipv4, &address, sizeof(ipv4));
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &ipv4.sin_addr, text.data(), text.size());
  return text.data();
}

int Mtu_B(const std::string& name) {
  int mtu_B = 0;
  std::ifstream("/sys/class/net/" + name + "/mtu") >> mtu_B;
  return mtu_B;
}

}  // namespace

std::vector<NetworkInterface> NetworkInterfaces() {
  std::map<std::string, NetworkInterface> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    NetworkInterface& interface = found[entry->ifa_name];
    interface.name = entry->ifa_name;
    interface.is_up = (entry->ifa_flags & IFF_UP) != 0;
    interface.is_loopback = (entry->ifa_flags & IFF_LOOPBACK) != 0;
    interface.has_multicast = (entry->ifa_flags & IFF_MULTICAST) != 0;
    if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET) {
      interface.addresses.push_back(AddressText(*entry->ifa_addr));
    }
  }
  freeifaddrs(list);
  std::vector<NetworkInterface> interfaces;
  for (auto& [name, interface] : found) {
    interface.mtu_B = Mtu_B(name);
    interfaces.push_back(std::move(interface));
  }
  return interfaces;
}

}  // namespace palpate
