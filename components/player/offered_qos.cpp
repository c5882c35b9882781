// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/offered_qos.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace palpate::player {

namespace {

/// "- history: 3" -> "history", "3".
std::pair<std::string_view, std::string_view> KeyAndValue(std::string_view line) {
  const auto trimmed = [](std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '-')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
    return text;
  };
  const std::size_t colon = line.find(':');
  if (colon == line.npos) return {};
  return {trimmed(line.substr(0, colon)), trimmed(line.substr(colon + 1))};
}

}  // namespace

std::optional<OfferedQos> ParseOfferedQos(std::string_view text) {
  std::optional<OfferedQos> offered;
  bool keeps_all = false;
  const auto qos = [&]() -> OfferedQos& {
    if (!offered) offered = OfferedQos{.reliable = false, .latched = false, .depth = 1};
    return *offered;
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto [key, value] = KeyAndValue(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    // Values of rmw_qos_profile_t: 1 reliable, 1 transient-local, 2 keep all.
    if (key == "reliability") qos().reliable |= value == "1" || value == "reliable";
    if (key == "durability") qos().latched |= value == "1" || value == "transient_local";
    if (key == "history") keeps_all |= value == "2" || value == "keep_all";
    if (key == "depth") {
      int depth = 0;
      std::from_chars(value.data(), value.data() + value.size(), depth);
      qos().depth = std::max(qos().depth, depth);
    }
  }
  if (offered && keeps_all) offered->depth = 0;
  return offered;
}

}  // namespace palpate::player
