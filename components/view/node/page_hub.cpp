// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/page_hub.hpp"

#include <utility>

#include "components/view/frames/binary_frame.hpp"
#include "components/view/serve/page_files.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/seconds.hpp"

namespace palpate::view {

namespace {

using Json = nlohmann::json;

constexpr double kMostRequests_hz = 50.0;
constexpr std::uint16_t kPolicyViolation = 1008;

bool IsImage(const std::string& kind) {
  return kind == "color_image" || kind == "depth_image" || kind == "segmentation";
}

bool IsCloud(const std::string& kind) { return kind == "robot_cloud" || kind == "object_cloud"; }

OutMessage RefusedMessage(const std::string& request, const std::string& reason) {
  return TextMessage("refused",
                     JsonText({{"kind", "refused"}, {"request", request}, {"reason", reason}}));
}

}  // namespace

PageHub::PageHub(PageGreeting greeting, WebServer* server, OnRequest on_request)
    : greeting_(std::move(greeting)),
      server_(server),
      on_request_(std::move(on_request)),
      snapshot_(std::make_shared<const std::string>("null")) {}

std::string PageHub::HelloText() const {
  return JsonText({{"kind", "hello"},
                   {"version", greeting_.version},
                   {"source", greeting_.source},
                   {"source_name", greeting_.source_name},
                   {"read_only", greeting_.read_only},
                   {"server_time_ns", std::to_string(WallNow_ns())},
                   {"has_probe", greeting_.has_probe}});
}

bool PageHub::IsWanted(const Client& client, const std::string& kind) {
  return (client.wanted.images || !IsImage(kind)) && (client.wanted.clouds || !IsCloud(kind));
}

void PageHub::Publish(OutMessage message) {
  server_->Post([this, message = std::move(message)] {
    for (const auto& [id, client] : clients_) {
      if (IsWanted(client, message.kind)) server_->Send(id, message);
    }
    latest_[message.kind] = message;
  });
}

void PageHub::Reply(ClientId client, OutMessage message) {
  server_->Post([this, client, message = std::move(message)] { server_->Send(client, message); });
}

void PageHub::Refuse(ClientId client, const std::string& request, const std::string& reason) {
  Reply(client, RefusedMessage(request, reason));
}

void PageHub::SetSnapshot(std::string json) {
  auto snapshot = std::make_shared<const std::string>(std::move(json));
  const std::lock_guard lock(mutex_);
  snapshot_ = std::move(snapshot);
}

void PageHub::Forget() {
  server_->Post([this] { latest_.clear(); });
}

void PageHub::TellCounts() {
  server_->Every(std::chrono::seconds(1), [this] {
    for (auto& [id, client] : clients_) {
      const ClientCounts counts = server_->CountsOf(id);
      server_->Send(
          id, TextMessage("client", JsonText({{"kind", "client"},
                                              {"sent", counts.sent},
                                              {"dropped", counts.dropped},
                                              {"queue_bytes", counts.queue_bytes},
                                              {"rate_hz", counts.sent - client.sent_before}})));
      client.sent_before = counts.sent;
    }
  });
}

HttpAnswer PageHub::Get(std::string_view path) {
  if (path != "/snapshot.json") return AnswerPageFile(path);
  const std::lock_guard lock(mutex_);
  return {.status = 200, .content_type = "application/json", .body = snapshot_};
}

std::optional<std::string> PageHub::Subprotocol(const std::vector<std::string>&) const {
  return std::string();
}

void PageHub::Opened(ClientId client) {
  const auto added = clients_.emplace(client, Client{{}, MessageBudget(kMostRequests_hz)}).first;
  Count();
  server_->Send(client, TextMessage("hello", HelloText()));
  for (const auto& [kind, message] : latest_) {
    if (IsWanted(added->second, kind)) server_->Send(client, message);
  }
}

void PageHub::Closed(ClientId client) {
  clients_.erase(client);
  Count();
}

void PageHub::Count() {
  int images = 0;
  int clouds = 0;
  for (const auto& [id, client] : clients_) {
    images += client.wanted.images ? 1 : 0;
    clouds += client.wanted.clouds ? 1 : 0;
  }
  clients_wanting_[kAll] = static_cast<int>(clients_.size());
  clients_wanting_[kImages] = images;
  clients_wanting_[kClouds] = clouds;
}

void PageHub::EndForBadRequest(ClientId client, const BadRequest& bad) {
  server_->Send(client, RefusedMessage(bad.kind, bad.reason));
  server_->Close(client, kPolicyViolation, bad.reason);
}

void PageHub::Received(ClientId client, std::string_view bytes, bool binary) {
  Client& sender = clients_.at(client);
  if (!sender.budget.Take(NsToSeconds(MonotonicNow_ns()))) {
    return EndForBadRequest(client, {"", "more than 50 requests per second"});
  }
  PageRequest request = binary ? BadRequest{"", "a request is a text"} : ParsePageRequest(bytes);
  if (const auto* bad = std::get_if<BadRequest>(&request)) return EndForBadRequest(client, *bad);
  if (const auto* wanted = std::get_if<SubscribeRequest>(&request)) {
    sender.wanted = *wanted;
    return Count();
  }
  on_request_(client, std::move(request));
}

}  // namespace palpate::view
