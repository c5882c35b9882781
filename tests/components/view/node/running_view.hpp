// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "components/view/node/node.hpp"
#include "tests/components/view/client/web_client.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::view {

/// The node in a thread of its own.
class RunningView {
 public:
  explicit RunningView(NodeConfig config = {}, ViewPlan plan = {})
      : node_(std::make_unique<ViewNode>(WithFreePorts(config), std::move(plan),
                                         static_cast<int>(dds::TestDomain()), dds::BuiltInTable(),
                                         dds::NodeLog::ProcessLog())),
        thread_([this] { node_->Run(); }) {}
  ~RunningView() {
    node_->Stop();
    thread_.join();
  }
  RunningView(const RunningView&) = delete;
  RunningView& operator=(const RunningView&) = delete;

  int page_port() const { return node_->page_port(); }
  int foxglove_port() const { return node_->foxglove_port(); }

 private:
  static NodeConfig WithFreePorts(NodeConfig config) {
    if (config.http.port == HttpConfig().port) config.http.port = 0;
    config.foxglove.port = 0;
    return config;
  }

  std::unique_ptr<ViewNode> node_;
  std::thread thread_;
};

/// What a client of Foxglove does.
class FoxgloveTest : public testing::Test {
 public:
  /// The channel of a topic, once it is advertised.
  static nlohmann::json Channel(WebClient* client, const std::string& topic) {
    while (const auto frame = client->ReadFrame()) {
      if (frame->opcode != 1) continue;
      const auto message = nlohmann::json::parse(frame->payload);
      if (message.at("op") != "advertise") continue;
      for (const nlohmann::json& channel : message.at("channels")) {
        if (channel.at("topic") == topic) return channel;
      }
    }
    return nullptr;
  }
  static void Subscribe(WebClient* client, int id, const nlohmann::json& channel) {
    client->SendText(
        nlohmann::json({{"op", "subscribe"},
                        {"subscriptions", {{{"id", id}, {"channelId", channel.at("id")}}}}})
            .dump());
  }
  static std::optional<std::string> NextData(WebClient* client) {
    while (const auto frame = client->ReadFrame()) {
      if (frame->opcode == 2) return frame->payload;
    }
    return std::nullopt;
  }
};

}  // namespace palpate::view
