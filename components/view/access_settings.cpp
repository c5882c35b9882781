// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/access_settings.hpp"

#include <algorithm>
#include <cctype>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::view {

namespace {

constexpr std::size_t kLeastToken = 16;
constexpr std::size_t kMostToken = 256;
constexpr const char* kMakeToken = "head -c 24 /dev/urandom | base64 | tr '+/' '-_'";

void CheckToken(const std::string& token, const std::string& source) {
  const bool writable = std::all_of(token.begin(), token.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  if (token.size() >= kLeastToken && token.size() <= kMostToken && writable) return;
  // The token itself is no matter for a log.
  throw InputError(source + ": a token has 16 to 256 letters, digits, - and _, not " +
                   std::to_string(token.size()) + " characters" +
                   (writable ? "" : " with others among them") + "; this makes one: " + kMakeToken);
}

std::string TokenIn(const std::filesystem::path& file) {
  std::string text = ReadFile(file);
  text.resize(std::min(text.find_first_of("\r\n"), text.size()));
  return text;
}

}  // namespace

std::string TokenOf(const HttpConfig& config, const std::string& from_environment) {
  if (!IsIpAddress(config.address)) {
    throw InputError("http.address: '" + config.address +
                     "' is no IP address; 127.0.0.1 is this machine only, 0.0.0.0 all networks");
  }
  std::string token;
  if (!config.token_file.empty()) {
    token = TokenIn(config.token_file);
    CheckToken(token, "http.token_file: " + config.token_file.string());
  } else if (!from_environment.empty()) {
    token = from_environment;
    CheckToken(token, kTokenVariable);
  }
  if (token.empty() && !IsLoopbackAddress(config.address)) {
    throw InputError("http.address: " + config.address +
                     " is open to the network, so clients must give a token: set http.token_file, "
                     "or " +
                     std::string(kTokenVariable) + "; this makes one: " + kMakeToken);
  }
  return token;
}

AccessRules PageRules(const HttpConfig& config, const std::string& token) {
  AccessRules rules;
  rules.token = token;
  // Browsers send the cookies of all ports of a machine.
  rules.cookie_name = "palpate_view_" + std::to_string(config.port);
  rules.any_literal_host = config.address == "0.0.0.0" || config.address == "::";
  for (const std::string& name : config.host_names) rules.hosts.push_back(HostWithoutPort(name));
  return rules;
}

AccessRules FoxgloveRules(const HttpConfig& http, const FoxgloveConfig& foxglove,
                          const std::string& token) {
  AccessRules rules = PageRules(http, token);
  rules.origins = foxglove.origins;
  rules.local_origins = true;
  return rules;
}

}  // namespace palpate::view
