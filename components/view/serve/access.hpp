// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::view {

/// Who may connect to a port.
struct AccessRules {
  std::string token;                 ///< empty: none is asked for
  std::string cookie_name;           ///< that holds the token
  std::vector<std::string> hosts;    ///< names and addresses by which this server is called
  bool any_literal_host = false;     ///< any IP address, too: the server listens on all of them
  std::vector<std::string> origins;  ///< of pages that may connect, besides those of this port
  bool local_origins = false;        ///< pages of any server on this machine may connect
};

/// What a request says of itself; empty where it does not say it.
struct RequestFacts {
  std::string_view target{};  ///< "/live?token=..."
  std::string_view host{};    ///< header Host
  std::string_view origin{};
  std::string_view cookie{};
  std::string_view authorization{};
};

struct Verdict {
  int status = 403;         ///< of HTTP; 200: granted
  std::string reason = {};  ///< of a refusal, with the remedy
  bool by_query = false;    ///< the token stood in the address: a cookie shall replace it there

  bool granted() const { return status == 200; }
};

/// A page of another site must reach no server on this machine: neither under a name that its DNS
/// points here (Host), nor by a WebSocket, for which browsers have no same-origin policy (Origin).
Verdict Judge(const AccessRules& rules, const RequestFacts& request);

/// Takes a time that does not depend on where the texts differ.
bool EqualInConstantTime(std::string_view a, std::string_view b);

/// "127.0.0.1", "[::1]:80" -> "::1", "localhost:8750" -> "localhost"; lower case. Empty: it is
/// none.
std::string HostWithoutPort(std::string_view host);
bool IsIpAddress(const std::string& host);
/// 127.0.0.0/8 or ::1.
bool IsLoopbackAddress(const std::string& address);

/// The part of a target before its query.
std::string_view PathOf(std::string_view target);

}  // namespace palpate::view
