// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate {

/// An interface of this host to a network.
struct NetworkInterface {
  std::string name;
  std::vector<std::string> addresses;  ///< IPv4
  bool is_up = false;
  bool is_loopback = false;
  bool has_multicast = false;
  int mtu_B = 0;  ///< largest IP packet; 0: unknown
};

/// Those of this host.
std::vector<NetworkInterface> NetworkInterfaces();

}  // namespace palpate
