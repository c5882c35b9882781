// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/access.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace palpate::view {

namespace {

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

bool Contains(const std::vector<std::string>& list, std::string_view one) {
  return std::find(list.begin(), list.end(), one) != list.end();
}

bool IsLocalName(const std::string& host) { return host == "localhost" || IsLoopbackAddress(host); }

bool IsHost(const AccessRules& rules, std::string_view header) {
  const std::string host = HostWithoutPort(header);
  if (host.empty()) return false;
  return Contains(rules.hosts, host) || (rules.any_literal_host && IsIpAddress(host));
}

/// "http://localhost:8750" -> "localhost:8750"; empty for other schemes.
std::string AuthorityOf(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return Lower(origin.substr(scheme.size()));
  }
  return {};
}

bool IsOrigin(const AccessRules& rules, const RequestFacts& request) {
  if (request.origin.empty()) return true;  // no browser
  const std::string authority = AuthorityOf(request.origin);
  if (!authority.empty() && authority == Lower(request.host)) return true;
  if (rules.local_origins && IsLocalName(HostWithoutPort(authority))) return true;
  return Contains(rules.origins, request.origin);
}

/// The value of NAME=VALUE in a list with this separator.
std::string_view ValueIn(std::string_view list, std::string_view name, char separator) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(separator), list.size());
    std::string_view pair = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=') {
      return pair.substr(name.size() + 1);
    }
  }
  return {};
}

std::string_view QueryOf(std::string_view target) {
  const std::size_t mark = target.find('?');
  return mark == target.npos ? std::string_view() : target.substr(mark + 1);
}

std::string_view BearerOf(std::string_view authorization) {
  constexpr std::string_view kScheme = "Bearer ";
  return authorization.starts_with(kScheme) ? authorization.substr(kScheme.size())
                                            : std::string_view();
}

}  // namespace

bool EqualInConstantTime(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

std::string HostWithoutPort(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == host.npos ? std::string() : Lower(host.substr(1, end - 1));
  }
  return Lower(host.substr(0, std::min(host.find(':'), host.size())));
}

bool IsIpAddress(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  return inet_pton(AF_INET, host.c_str(), address.data()) == 1 ||
         inet_pton(AF_INET6, host.c_str(), address.data()) == 1;
}

bool IsLoopbackAddress(const std::string& address) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  if (inet_pton(AF_INET, address.c_str(), bytes.data()) == 1) return bytes[0] == 127;
  return inet_pton(AF_INET6, address.c_str(), bytes.data()) == 1 && bytes.back() == 1 &&
         std::all_of(bytes.begin(), bytes.end() - 1, [](unsigned char byte) { return byte == 0; });
}

std::string_view PathOf(std::string_view target) {
  return target.substr(0, std::min(target.find('?'), target.size()));
}

Verdict Judge(const AccessRules& rules, const RequestFacts& request) {
  if (!IsHost(rules, request.host)) {
    return {421, "this server is not called '" + HostWithoutPort(request.host) +
                     "'; use its address, or add the name to the setting http.host_names"};
  }
  if (!IsOrigin(rules, request)) {
    return {403, "a page of '" + std::string(request.origin) + "' may not connect"};
  }
  if (rules.token.empty()) return {200};
  if (EqualInConstantTime(ValueIn(QueryOf(request.target), "token", '&'), rules.token)) {
    return {200, {}, true};
  }
  if (EqualInConstantTime(ValueIn(request.cookie, rules.cookie_name, ';'), rules.token) ||
      EqualInConstantTime(BearerOf(request.authorization), rules.token)) {
    return {200};
  }
  return {401,
          "a token is needed: open the address with ?token=..., or send the header "
          "'Authorization: Bearer ...'"};
}

}  // namespace palpate::view
