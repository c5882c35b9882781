// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/view/node/page_feed.hpp"

namespace palpate::view {

using Json = nlohmann::json;

/// Keeps what a feed tells the page.
class PageMessages {
 public:
  /// Must not outlive this.
  FeedOutputs Outputs() {
    return {.publish = [this](const OutMessage& message) { Add(message); },
            .wants_clouds = [] { return true; },
            .wants_images = [] { return true; },
            .publish_scene = [](const std::string&, std::int64_t) {},
            .wants_scene = [] { return false; },
            .warn = [this](const std::string& text) { warnings_.push_back(text); }};
  }

  /// The fields of the newest message of this kind; null: none has come.
  Json Last(const std::string& kind) const {
    const auto found = messages_.find(kind);
    return found == messages_.end() ? Json() : found->second.back();
  }
  std::size_t Count(const std::string& kind) const {
    const auto found = messages_.find(kind);
    return found == messages_.end() ? 0 : found->second.size();
  }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void Add(const OutMessage& message) {
    std::string_view text = *message.head;
    if (message.binary) {
      std::uint32_t size = 0;
      std::memcpy(&size, text.data(), sizeof(size));
      text = text.substr(sizeof(size), size);
    }
    messages_[message.kind].push_back(Json::parse(text));
  }

  std::map<std::string, std::vector<Json>> messages_;
  std::vector<std::string> warnings_;
};

}  // namespace palpate::view
