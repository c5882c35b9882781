// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/topic_choice.hpp"

#include <algorithm>

namespace palpate::recording {

bool Matches(std::string_view text, std::string_view pattern) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() != '*') {
    return !text.empty() && text.front() == pattern.front() &&
           Matches(text.substr(1), pattern.substr(1));
  }
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (Matches(text.substr(i), pattern.substr(1))) return true;
  }
  return false;
}

bool TopicChoice::Includes(std::string_view topic) const {
  const auto fits = [&](const std::string& pattern) { return Matches(topic, pattern); };
  return (wanted.empty() || std::any_of(wanted.begin(), wanted.end(), fits)) &&
         std::none_of(excluded.begin(), excluded.end(), fits);
}

bool IsRosInternal(std::string_view dds_topic) {
  return dds_topic == "ros_discovery_info" || dds_topic.starts_with("rq/") ||
         dds_topic.starts_with("rr/");
}

}  // namespace palpate::recording
