// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/frames/page_request.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace palpate::view {

namespace {

using Json = nlohmann::json;

std::optional<bool> BoolIn(const Json& request, const char* key) {
  const auto value = request.find(key);
  if (value == request.end() || !value->is_boolean()) return std::nullopt;
  return value->get<bool>();
}

std::optional<double> NumberIn(const Json& request, const char* key) {
  const auto value = request.find(key);
  if (value == request.end() || !value->is_number()) return std::nullopt;
  const auto number = value->get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

PageRequest ParseProbe(const Json& request) {
  const auto vertex = request.find("vertex");
  if (vertex == request.end() || !vertex->is_number_unsigned() ||
      vertex->get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    return BadRequest{"probe", "vertex is the number of a node of the surface"};
  }
  return ProbeRequest{vertex->get<std::uint32_t>()};
}

PageRequest ParseRecord(const Json& request) {
  const auto on = BoolIn(request, "on");
  if (!on) return BadRequest{"record", "on is true or false"};
  return RecordRequest{*on};
}

PageRequest ParsePlay(const Json& request) {
  const auto paused = BoolIn(request, "paused");
  const auto rate = NumberIn(request, "rate");
  if (!paused || !rate || *rate < kLeastRate || *rate > kMostRate) {
    return BadRequest{"play", "paused is true or false, rate from 0.01 to 100"};
  }
  return PlayRequest{*paused, *rate};
}

PageRequest ParseSeek(const Json& request) {
  const auto position_s = NumberIn(request, "position_s");
  if (!position_s || *position_s < 0.0) return BadRequest{"seek", "position_s is 0 or above"};
  return SeekRequest{*position_s};
}

PageRequest ParseSubscribe(const Json& request) {
  const auto images = BoolIn(request, "images");
  const auto clouds = BoolIn(request, "clouds");
  if (!images || !clouds) return BadRequest{"subscribe", "images and clouds are true or false"};
  return SubscribeRequest{*images, *clouds};
}

}  // namespace

PageRequest ParsePageRequest(std::string_view text) {
  if (text.size() > kMostRequestBytes) return BadRequest{"", "longer than 4 KiB"};
  const Json request = Json::parse(text, nullptr, false);
  if (!request.is_object() || !request.contains("kind") || !request["kind"].is_string()) {
    return BadRequest{"", "a request is a JSON object with kind"};
  }
  const auto kind = request["kind"].get<std::string>();
  if (kind == "probe") return ParseProbe(request);
  if (kind == "record") return ParseRecord(request);
  if (kind == "play") return ParsePlay(request);
  if (kind == "seek") return ParseSeek(request);
  if (kind == "subscribe") return ParseSubscribe(request);
  constexpr std::size_t kMostShown = 40;
  return BadRequest{kind.substr(0, kMostShown), "unknown kind"};
}

}  // namespace palpate::view
